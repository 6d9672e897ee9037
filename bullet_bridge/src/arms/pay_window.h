#pragma once

namespace tandem {

/// When forces of a host's step act in the island.
struct PayWindow {
  double dt = 0.0;        ///< the host's step [s]
  double end = 0.0;       ///< when its forces have acted, by the island's time [s]
  double rest = 0.0;      ///< time until then [s]
  double pay_over = 0.0;  ///< of the ticks before the host's next step [s]; 0: no step begins

  /// Force over these ticks that gives what is owed, `force` over the step included.
  [[nodiscard]] double findForce(double force, double owed) const noexcept {
    return force + (owed - rest * force) / pay_over;
  }
};

}  // namespace tandem
