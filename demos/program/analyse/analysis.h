#pragma once

#include <array>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tandem/coordination/stability_advice.h"

namespace tandem::demos {

/// A hand that holds its device, as people do who do not push.
inline constexpr HandImpedance kHeldHand{0.0, 300.0, 5.0};

/// Tells how a scenario's gains behave, with empty hands and with hands that hold.
struct Analysis {
  LoopSettings loop;
  Advice advice;
  std::array<double, 2> held_rates{};  ///< of common and difference, held by kHeldHand [1/s]
  double drag = 0.0;                   ///< of common motion [N s/m]
  /// Worst rate over eight phases of packets [1/s]; empty for more users than four.
  std::optional<double> worst_phase;
};

/// Throws as advise() does.
[[nodiscard]] Analysis analyse(const LoopSettings& loop);

/// True if all lasting modes of empty hands die out.
[[nodiscard]] bool isStable(const Analysis& analysis) noexcept;

/// "against each other"
[[nodiscard]] const char* explain(MotionMode mode) noexcept;
[[nodiscard]] nlohmann::json toJson(const Analysis& analysis);
/// For a reader, with line ends.
[[nodiscard]] std::string describe(const Analysis& analysis);

}  // namespace tandem::demos
