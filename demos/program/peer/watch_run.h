#pragma once

#include <optional>
#include <string>

#include "peer/peer_line.h"

namespace tandem::demos {

/// `tandem peer --watch`: follows the sites of a relay's room without a hand. Says a line a second,
/// writes watch.csv to `folder`, and ends by a signal or after `line.patience` without a state.
/// With a `scenario` that of the sites must fit. Throws UsageError for missing options, and as
/// WatchCheck does.
void watchSites(const PeerLine& line, const Scenario* scenario,
                const std::optional<std::string>& folder, bool is_quiet);

}  // namespace tandem::demos
