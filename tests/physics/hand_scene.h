#pragma once

#include <memory>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem::test {

/// Roles in which the hand may meet a body.
enum class Role { kStanding, kKinematic, kNeighbour, kShared };

/// A hand at one body that it cannot move, in a world without weight.
struct HandScene {
  static constexpr double kRate = 240.0;        // of the host [Hz]
  static constexpr double kStiffness = 2000.0;  // of contact [N/m]
  static constexpr double kHeavy = 1e12;        // [kg]

  BulletRig rig;
  FakeDevice device;
  std::unique_ptr<Site> site;
  btRigidBody* body = nullptr;

  explicit HandScene(const Vec3& hand_W) : device(hand_W) {}

  void start(btCollisionShape& shape, Role role) {
    const bool is_fixed = role == Role::kStanding || role == Role::kKinematic;
    body = &rig.addBody(shape, is_fixed ? 0.0 : kHeavy);
    const auto inertia = static_cast<btScalar>(kHeavy);  // small things turn easily
    if (!is_fixed) body->setMassProps(inertia, btVector3(inertia, inertia, inertia));
    body->updateInertiaTensor();
    if (role == Role::kKinematic)
      body->setCollisionFlags(body->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    body->setActivationState(DISABLE_DEACTIVATION);
    SiteSettings settings;
    settings.peers = 1;
    settings.contact = {kStiffness, 0.0};
    settings.passivity.enabled = false;
    site = std::make_unique<Site>(settings, rig.world, device);
    if (role == Role::kShared) site->share(*body);
    run(0.05);
  }
  void run(double duration) {
    for (int i = 0; i < duration * kRate; ++i) rig.step(1.0 / kRate);
  }
  /// Moves the hand there in 0.2 s and waits; the force then.
  Vec3 press(const Vec3& to_W) {
    const Vec3 from_W = device.sample.hip.p_W;
    const int steps = static_cast<int>(0.2 * kRate);
    const Vec3 v_W = (to_W - from_W) / 0.2;
    for (int i = 1; i <= steps; ++i) {
      device.sample.hip = {from_W + (to_W - from_W) * i / steps, v_W};
      rig.step(1.0 / kRate);
    }
    device.sample.hip.v_W.setZero();
    run(0.25);
    return device.force_W;
  }
};

}  // namespace tandem::test
