#pragma once

namespace tandem::reference {

/// Gains of a spring-damper, for contacts and for coordination couplings.
struct SpringDamper {
  double stiffness = 0.0;  ///< [N/m], or [N m/rad] for a rotation
  double damping = 0.0;    ///< [N s/m], or [N m s/rad] for a rotation
};

}  // namespace tandem::reference
