#pragma once

#include "tandem/coordination/types.h"

namespace tandem {

/// Index of a body in its island, in the order in which bodies were added.
using BodyIndex = int;

/// Rigid contact (no overlap, Coulomb friction) of island bodies with what stands around them.
///
/// The island knows couplers and smooth contact; rigid rows are somebody else's: `bullet_bridge`
/// solves them in a private Bullet world. All functions run in the tick: no throw, no allocation
/// after warm-up.
class RigidContacts {
 public:
  virtual ~RigidContacts() = default;

  /// True if the body could touch anything rigid within `reach` [m] of where it is. Cheap: the
  /// island asks before it leaves the exact maps for inner steps.
  [[nodiscard]] virtual bool isNear(BodyIndex body, const RigidState& state,
                                    double reach) const noexcept = 0;

  /// Announces the smooth motion of one body over the coming inner step: it starts at `before` and,
  /// if nothing rigid stood in the way, would end with the velocities of `after`.
  virtual void predict(BodyIndex body, const RigidState& before,
                       const RigidState& after) noexcept = 0;

  /// Solves all predicted bodies together over `dt` [s].
  virtual void solve(double dt) noexcept = 0;

  /// Replaces `after` by the corrected pose and velocity if anything rigid touched the body in the
  /// last solve; returns whether it did.
  virtual bool correct(BodyIndex body, RigidState& after) noexcept = 0;
};

}  // namespace tandem
