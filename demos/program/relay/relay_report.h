#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tandem/plugin/relay.h"

namespace tandem::demos {

/// The status of a relay as JSON. `time` [s] since its start.
[[nodiscard]] nlohmann::json makeRelayReport(const RelayStatus& status, double time);

/// One line with rates since `before`, which was `period` [s] ago, and the names of some rooms.
[[nodiscard]] std::string formatRelayLine(const RelayStatus& status, const RelayStatus& before,
                                          double period);

/// One line with sums, for the end.
[[nodiscard]] std::string formatRelaySum(const RelayStatus& status);

}  // namespace tandem::demos
