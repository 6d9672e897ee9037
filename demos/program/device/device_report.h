#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tandem/falcon/falcon_status.h"

namespace tandem::demos {

/// How a device does, whichever it is, for people and for JSON.
struct DeviceReport {
  std::string state;                  ///< one word: "ready"
  std::string trouble;                ///< what is wrong and what to do; empty: nothing
  bool is_ready = false;              ///< positions are true
  bool is_hopeless = false;           ///< somebody must do what `trouble` says
  bool is_starting = false;           ///< opened, booted or loaded; nothing for the user to do yet
  std::optional<std::uint8_t> homed;  ///< bit i: leg i + 1; nothing: it needs no homing
  std::uint32_t loaded = 0, image = 0;  ///< of the firmware, while it is loaded [bytes]
  std::uint8_t buttons = 0;             ///< a bit for each
  std::uint64_t readings = 0;           ///< that the device gave so far
  std::vector<std::pair<std::string, std::uint64_t>> counters;
  std::optional<FalconRoundTrips> round_trips;
};

/// Of a Falcon.
[[nodiscard]] DeviceReport describe(const FalconStatus& status);

}  // namespace tandem::demos
