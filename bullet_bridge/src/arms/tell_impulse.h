#pragma once

#include "arms/constraint_fields.h"

namespace tandem {

/// The impulse of a constraint's row in Bullet's last step [N s or N m s]; 0: it made none yet.
[[nodiscard]] inline double readImpulse(btMultiBodyConstraint& constraint, int row) noexcept {
  if ((constraint.*ConstraintFields::kData).size() <= row) return 0.0;
  return static_cast<double>(constraint.getAppliedImpulse(row));
}

/// Tells the host an impulse, if Bullet has made room for it: some do so in their first step.
inline void tellImpulse(btMultiBodyConstraint& constraint, int row, double impulse) noexcept {
  if ((constraint.*ConstraintFields::kData).size() > row)
    constraint.internalSetAppliedImpulse(row, static_cast<btScalar>(impulse));
}

}  // namespace tandem
