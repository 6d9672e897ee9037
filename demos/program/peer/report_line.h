#pragma once

#include <string>

#include "peer/peer_run.h"

namespace tandem::demos {

/// A line for the user. Of several other sites it has the largest values, how many are live, and
/// the first one that is not.
[[nodiscard]] std::string describeReport(const PeerReport& report);

}  // namespace tandem::demos
