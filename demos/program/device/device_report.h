#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tandem/falcon/falcon_status.h"

namespace tandem::demos {

/// State of a device of any kind, for people and for JSON.
struct DeviceReport {
  std::string state;                    ///< one word: "ready"
  std::string trouble;                  ///< problem and remedy; empty: none
  bool is_ready = false;                ///< positions are valid
  bool is_hopeless = false;             ///< the user must do what `trouble` says
  bool is_starting = false;             ///< being opened, booted or loaded; the user need not act
  std::optional<std::uint8_t> homed;    ///< bit i: leg i + 1; empty: needs no homing
  std::uint32_t loaded = 0, image = 0;  ///< bytes of the firmware, while loading
  std::uint8_t buttons = 0;             ///< one bit for each
  std::uint64_t readings = 0;           ///< number of readings so far
  std::vector<std::pair<std::string, std::uint64_t>> counters;
  std::optional<FalconRoundTrips> round_trips;
};

/// Report of a Falcon.
[[nodiscard]] DeviceReport describe(const FalconStatus& status);

/// Report of a device that is ready while it is plugged in, without its counters.
template <typename Status>
[[nodiscard]] DeviceReport describePlugged(const Status& status) {
  DeviceReport report;
  report.state = status.is_connected ? "ready" : "unplugged";
  report.trouble = status.trouble;
  report.is_ready = status.is_connected;
  report.readings = status.counters.reports;
  report.buttons = static_cast<std::uint8_t>(status.state.buttons);
  return report;
}

}  // namespace tandem::demos
