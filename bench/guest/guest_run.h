#pragma once

#include <cstdint>
#include <string_view>

#include "bench/guest/guest_case.h"

namespace tandem::demos::bench {

/// Kinds of failure of a random world.
enum class GuestFailure : std::int32_t {
  kNone,
  kCrash,      ///< the process ended, or hung
  kThrow,      ///< an exception left a call that must not throw here
  kNotFinite,  ///< a body, a force or the island
  kFell,       ///< a body went through what stands, and its twin did not
  kEnergy,     ///< more motion than hands, acts and twins account for
  kTwin,       ///< a body that nobody touched is elsewhere than its twin
  kRestored,   ///< a setting differs from the twin's after the site's end
  kGoesOn,     ///< after the site's end the world moves on in another way than a fresh one
};
inline constexpr int kGuestFailureCount = 9;
[[nodiscard]] std::string_view nameOf(GuestFailure failure);

/// Outcome of a case. A plain value, so that a worker process can pass it as bytes.
struct GuestOutcome {
  std::uint64_t index = 0;
  GuestFailure failure = GuestFailure::kNone;
  double time = 0.0;      ///< of the failure [s]
  double energy = 0.0;    ///< largest share of the allowed energy
  double seconds = 0.0;   ///< run time [s]
  std::int32_t acts = 0;  ///< done
  char text[200] = {};    ///< about the failure
};

/// Runs a case. It ends at its first failure.
[[nodiscard]] GuestOutcome runGuestCase(const GuestCase& one);

}  // namespace tandem::demos::bench
