#pragma once

#include <cstdint>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "coordination/src/fnv.h"

namespace tandem::test {

/// All settings of a body that attaching may touch, compared bit for bit. Clears its forces.
[[nodiscard]] inline std::vector<btScalar> readSettings(btRigidBody& body) {
  std::vector<btScalar> numbers = {body.getInvMass(),
                                   body.getLinearDamping(),
                                   body.getAngularDamping(),
                                   static_cast<btScalar>(body.getActivationState()),
                                   static_cast<btScalar>(body.getFlags()),
                                   static_cast<btScalar>(body.getCollisionFlags()),
                                   body.getFriction(),
                                   body.getRestitution(),
                                   body.getContactProcessingThreshold(),
                                   body.getLinearSleepingThreshold(),
                                   body.getAngularSleepingThreshold()};
  const auto add = [&](const btVector3& v) {
    numbers.insert(numbers.end(), {v.x(), v.y(), v.z()});
  };
  add(body.getInvInertiaDiagLocal());
  add(body.getGravity());
  add(body.getLinearFactor());
  add(body.getAngularFactor());
  // The weight has no getter, so it is read as the force that gravity adds.
  body.clearForces();
  body.applyGravity();
  add(body.getTotalForce());
  body.clearForces();
  return numbers;
}

/// FNV-1a hash over the bits of numbers.
class BitHash {
 public:
  template <typename Value>
  void add(const Value& value) {
    fnv_.addBytes(&value, sizeof value);
  }
  void add(const btVector3& v) {
    for (int axis = 0; axis < 3; ++axis) add(v[axis]);
  }
  void add(const btTransform& pose) {
    add(pose.getOrigin());
    for (int row = 0; row < 3; ++row) add(pose.getBasis()[row]);
  }
  /// Adds a body's motion: pose, velocity, sleep timer and interpolated pose.
  void add(const btRigidBody& body) {
    add(body.getWorldTransform());
    add(body.getLinearVelocity());
    add(body.getAngularVelocity());
    add(body.getInterpolationWorldTransform());
    add(body.getInterpolationLinearVelocity());
    add(body.getInterpolationAngularVelocity());
    add(body.getDeactivationTime());
    add(body.getActivationState());
    add(body.getIslandTag());
  }
  [[nodiscard]] std::uint64_t value() const { return fnv_.value(); }

 private:
  Fnv fnv_;
};

}  // namespace tandem::test
