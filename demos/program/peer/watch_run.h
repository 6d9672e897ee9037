#pragma once

#include <optional>
#include <string>

#include "peer/peer_line.h"

namespace tandem::demos {

/// Says where a spectator puts the states that it sees.
struct WatchOutput {
  std::optional<std::string> folder;   ///< of watch.csv
  std::optional<std::string> publish;  ///< word of `--publish`
  bool is_quiet = false;
};

/// `tandem peer --watch`: follows the sites of a relay's room without a hand. Says a line a second,
/// and ends by a signal or after `line.patience` without a state. With a `scenario` that of the
/// sites must fit. Throws UsageError for missing options, and as WatchCheck does.
void watchSites(const PeerLine& line, const Scenario* scenario, const WatchOutput& output);

}  // namespace tandem::demos
