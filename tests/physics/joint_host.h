#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem::test {

/// A host with links that hang on joints, a device and a site.
struct JointHost {
  static constexpr double kGravity = 9.81;                            // [m/s^2], along -z
  static constexpr double kLength = 0.2, kWidth = 0.04, kMass = 0.5;  // of a link [m], [kg]
  /// Energy of a link of the height of its length [J].
  static constexpr double kUnit = kMass * kGravity * kLength;

  BulletRig rig{Vec3(0.0, 0.0, -kGravity)};
  FakeDevice device{Vec3(10.0, 0.0, 0.0)};  ///< far away
  std::vector<std::unique_ptr<btTypedConstraint>> joints;
  std::vector<btRigidBody*> links;
  std::unique_ptr<Site> site;

  JointHost() = default;
  ~JointHost() {
    site.reset();
    for (const auto& joint : joints) rig.world.removeConstraint(joint.get());
  }
  JointHost(const JointHost&) = delete;
  JointHost& operator=(const JointHost&) = delete;

  btRigidBody& addLink(const Vec3& p_W, double mass = kMass) {
    const Vec3 half(0.5 * kLength, 0.5 * kWidth, 0.5 * kWidth);
    btRigidBody& link = add(rig.makeShape<btBoxShape>(toBullet(half)), mass, p_W);
    link.getCollisionShape()->setMargin(btScalar(0.001));
    return link;
  }
  btRigidBody& add(btCollisionShape& shape, double mass, const Vec3& p_W,
                   const Quat& q_WB = Quat::Identity()) {
    btRigidBody& link = rig.addBody(shape, mass, p_W, q_WB);
    link.setSleepingThresholds(0, 0);
    links.push_back(&link);
    return link;
  }
  template <typename Joint, typename... Arguments>
  Joint& join(Arguments&&... arguments) {
    auto joint = std::make_unique<Joint>(std::forward<Arguments>(arguments)...);
    Joint& reference = *joint;
    joints.push_back(std::move(joint));
    rig.world.addConstraint(&reference, true);
    return reference;
  }
  void share(btRigidBody& body, SiteSettings settings = {}, const CouplerGains& coordination = {}) {
    settings.coordination = coordination;
    site = std::make_unique<Site>(settings, rig.world, device);
    site->share(body);
  }

  /// Adds up the kinetic and potential energy of all links [J].
  [[nodiscard]] double energy() const {
    double sum = 0.0;
    for (const btRigidBody* link : links) {
      const double m = 1.0 / static_cast<double>(link->getInvMass());
      const Vec3 v = fromBullet(link->getLinearVelocity());
      const Quat q = fromBullet(link->getWorldTransform().getRotation());
      const Vec3 w = q.conjugate() * fromBullet(link->getAngularVelocity());
      const Vec3 inertia = fromBullet(link->getInvInertiaDiagLocal()).cwiseInverse();
      sum += 0.5 * m * v.squaredNorm() + 0.5 * w.dot(inertia.cwiseProduct(w)) +
             m * kGravity * static_cast<double>(link->getWorldTransform().getOrigin().z());
    }
    return sum;
  }
  /// Distance of two points of bodies, or of one and a place in W.
  [[nodiscard]] static double gap(const btRigidBody& a, const Vec3& at_A, const Vec3& place_W) {
    return (fromBullet(a.getWorldTransform() * toBullet(at_A)) - place_W).norm();
  }
  [[nodiscard]] static double gap(const btRigidBody& a, const Vec3& at_A, const btRigidBody& b,
                                  const Vec3& at_B) {
    return gap(a, at_A, fromBullet(b.getWorldTransform() * toBullet(at_B)));
  }
};

}  // namespace tandem::test
