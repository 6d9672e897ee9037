#pragma once

#include <optional>
#include <string>

#include "peer/peer_line.h"

namespace tandem::demos {

/// `tandem peer --watch`: follows the sites of a relay's room without a hand. Says a line a second,
/// writes watch.csv to `folder`, and ends by a signal or after `line.patience` without a state.
/// Throws UsageError for missing options, and tandem::Error if no site was heard.
void watchSites(const PeerLine& line, const std::optional<std::string>& folder, bool is_quiet);

}  // namespace tandem::demos
