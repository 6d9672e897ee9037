#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tandem/coordination/contact_outlook.h"
#include "tandem/coordination/stability_advice.h"

namespace tandem::demos {

/// Tells how a scenario's gains behave, with empty hands and with hands that hold.
struct Analysis {
  LoopSettings loop;
  Advice advice;
  std::vector<double> held_rates;  ///< of the lasting modes, with kHeldHand [1/s]
  double packet_rate = 0.0;        ///< that was analysed [Hz]
  double drag = 0.0;               ///< of common motion [N s/m]
  /// Worst rate over eight phases of packets [1/s]; empty for more users than four.
  std::optional<double> worst_phase;
  /// Worst rate over half a packet period less and more delay, and jitter.
  struct {
    double rate = 0.0, delay = 0.0;  ///< [1/s], [s]
  } worst_delay;
  std::optional<ContactOutlook> contact;  ///< empty with an object
};

/// `jitter`: by which packets may be later [s]. Throws as advise() does.
[[nodiscard]] Analysis analyse(const LoopSettings& loop, double jitter = 0.0);

/// True if all lasting modes of empty hands die out.
[[nodiscard]] bool isStable(const Analysis& analysis) noexcept;
/// The same for all phases and delays that were tried.
[[nodiscard]] bool isStableAtWorst(const Analysis& analysis) noexcept;

/// "against each other"
[[nodiscard]] const char* explain(MotionMode mode) noexcept;
[[nodiscard]] nlohmann::json toJson(const Analysis& analysis);
/// For a reader, with line ends.
[[nodiscard]] std::string describe(const Analysis& analysis);

}  // namespace tandem::demos
