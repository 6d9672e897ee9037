#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace tandem {

/// Weight that Bullet stores for the body, in W and without its linear factor; Bullet has no
/// getter. The body stays unchanged.
[[nodiscard]] btVector3 measureWeight(btRigidBody& body) noexcept;

#pragma GCC visibility push(default)
/// The weight that Bullet has applied in this step, of a body whose mass is about to change in a
/// tick. A body that was asleep has none.
class WeightInStep {
 public:
  explicit WeightInStep(btRigidBody& body) noexcept;
  /// Puts the weight of its mass now in place of it; other forces stay.
  void follow(btRigidBody& body) const noexcept;

 private:
  btVector3 weight_;
  bool is_applied_;
};
#pragma GCC visibility pop

/// Restores inverse mass and inverse inertia to the bit. Restores the weight too if it fits them
/// and the body's present gravity; else the weight becomes that of setGravity().
void restoreMass(btRigidBody& body, btScalar inverse_mass, const btVector3& inverse_inertia,
                 const btVector3& weight) noexcept;

}  // namespace tandem
