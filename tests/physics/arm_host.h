#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "host/any_host.h"
#include "support/fakes.h"

namespace tandem::test {

/// A link of an arm: a box of `half`, that hangs on its parent by a joint.
struct ArmLinkPlan {
  btMultibodyLink::eFeatherstoneJointType joint = btMultibodyLink::eRevolute;
  Vec3 axis = Vec3::UnitY();
  double mass = 0.5;
  Vec3 half = Vec3(0.1, 0.02, 0.02);
  Vec3 e = Vec3::Zero();         ///< from the parent's centre to the joint
  Vec3 d = Vec3(0.1, 0.0, 0.0);  ///< from the joint to the centre
  int parent = -2;               ///< -2: the link before
  bool has_shape = true;
};

/// A host with a multi-body, a device and a site.
struct ArmHost {
  static constexpr double kGravity = 9.81;  // along -z

  explicit ArmHost(const Vec3& gravity_W = Vec3(0.0, 0.0, -kGravity))
      : host(WorldKind::kMultiBody, gravity_W) {}
  ~ArmHost() {
    site.reset();
    for (const auto& one : constraints) host.multi()->removeMultiBodyConstraint(one.get());
    for (const auto& one : others) host.multi()->removeMultiBody(one.get());
  }
  ArmHost(const ArmHost&) = delete;
  ArmHost& operator=(const ArmHost&) = delete;

  /// Makes the multi-body. `base_mass` 0: the base is fixed. A base with a shape is a box.
  void build(const std::vector<ArmLinkPlan>& plan, double base_mass = 0.0,
             const Vec3& base_half = Vec3::Zero(), const Vec3& p_W = Vec3::Zero()) {
    btVector3 inertia(0, 0, 0);
    btBoxShape* base_shape = nullptr;
    if (base_half != Vec3::Zero()) {
      base_shape = &host.makeBox(base_half);
      base_shape->calculateLocalInertia(static_cast<btScalar>(base_mass), inertia);
    }
    host.multi_body = std::make_unique<btMultiBody>(static_cast<int>(plan.size()),
                                                    static_cast<btScalar>(base_mass), inertia,
                                                    base_mass == 0.0, false);
    btMultiBody& arm = *host.multi_body;
    arm.setBasePos(toBullet(p_W));
    const btQuaternion straight = btQuaternion::getIdentity();
    for (int i = 0; i < static_cast<int>(plan.size()); ++i) {
      const ArmLinkPlan& link = plan[static_cast<std::size_t>(i)];
      const int parent = link.parent == -2 ? i - 1 : link.parent;
      const auto mass = static_cast<btScalar>(link.mass);
      inertia.setZero();
      if (link.mass > 0.0) host.makeBox(link.half).calculateLocalInertia(mass, inertia);
      const btVector3 e = toBullet(link.e), d = toBullet(link.d), axis = toBullet(link.axis);
      switch (link.joint) {
        case btMultibodyLink::ePrismatic:
          arm.setupPrismatic(i, mass, inertia, parent, straight, axis, e, d, true);
          break;
        case btMultibodyLink::eSpherical:
          arm.setupSpherical(i, mass, inertia, parent, straight, e, d, true);
          break;
        case btMultibodyLink::ePlanar:
          arm.setupPlanar(i, mass, inertia, parent, straight, axis, e, true);
          break;
        case btMultibodyLink::eFixed:
          arm.setupFixed(i, mass, inertia, parent, straight, e, d);
          break;
        default:
          arm.setupRevolute(i, mass, inertia, parent, straight, axis, e, d, true);
      }
    }
    arm.finalizeMultiDof();
    arm.setLinearDamping(0);
    arm.setAngularDamping(0);
    arm.setHasSelfCollision(false);
    host.multi()->addMultiBody(&arm);
    if (base_shape) arm.setBaseCollider(&addCollider(-1, *base_shape));
    for (int i = 0; i < static_cast<int>(plan.size()); ++i) {
      const ArmLinkPlan& link = plan[static_cast<std::size_t>(i)];
      if (link.has_shape) arm.getLink(i).m_collider = &addCollider(i, host.makeBox(link.half));
    }
    showPose();
  }
  /// The next build() makes another multi-body, which is arm() then.
  btMultiBody& putAside() {
    others.push_back(std::move(host.multi_body));
    return *others.back();
  }
  btMultiBodyLinkCollider& addCollider(int link, btBoxShape& shape) {
    shape.setMargin(btScalar(0.001));
    auto collider = std::make_unique<btMultiBodyLinkCollider>(host.multi_body.get(), link);
    collider->setCollisionShape(&shape);
    collider->setFriction(btScalar(0.5));
    host.world->addCollisionObject(collider.get(), btBroadphaseProxy::DefaultFilter,
                                   btBroadphaseProxy::AllFilter);
    host.colliders.push_back(std::move(collider));
    return *host.colliders.back();
  }
  /// After a change of joint positions.
  void showPose() {
    btAlignedObjectArray<btQuaternion> turns;
    btAlignedObjectArray<btVector3> origins;
    arm().forwardKinematics(turns, origins);
    arm().updateCollisionObjectWorldTransforms(turns, origins);
    host.world->updateAabbs();
  }
  /// Adds a constraint of a link.
  template <typename Constraint, typename... Arguments>
  Constraint& add(int link, Arguments&&... arguments) {
    auto one = std::make_unique<Constraint>(&arm(), link, std::forward<Arguments>(arguments)...);
    Constraint& reference = *one;
    constraints.push_back(std::move(one));
    host.multi()->addMultiBodyConstraint(&reference);
    return reference;
  }
  btMultiBodyJointMotor& addMotor(int link, double speed, double impulse) {
    return add<btMultiBodyJointMotor>(link, static_cast<btScalar>(speed),
                                      static_cast<btScalar>(impulse));
  }
  void addLimit(int link, double low, double high) {
    add<btMultiBodyJointLimitConstraint>(link, static_cast<btScalar>(low),
                                         static_cast<btScalar>(high));
  }
  void remove(btMultiBodyConstraint& constraint) {
    host.multi()->removeMultiBodyConstraint(&constraint);
    std::erase_if(constraints, [&](const auto& one) { return one.get() == &constraint; });
  }
  /// Puts the hand beside the first joint of a chain, where nothing touches it.
  void putHandBeside() {
    const double radius = SiteSettings().hip_radius;
    device.sample.hip.p_W = Vec3(0.0, 0.02 + radius + 0.0008, 0.0);
  }
  void start(const SiteSettings& settings = {}) {
    site = std::make_unique<Site>(settings, *host.world, device);
  }
  /// The hand holds what is near, and touches nothing.
  void startApart() {
    device.sample.hip.p_W = Vec3(0.0, 0.4, 0.0);
    SiteSettings settings;
    settings.host_stall = 0.2;
    start(settings);
  }

  [[nodiscard]] btMultiBody& arm() const { return *host.multi_body; }
  [[nodiscard]] double q(int link) const { return static_cast<double>(arm().getJointPos(link)); }
  [[nodiscard]] double u(int link) const { return static_cast<double>(arm().getJointVel(link)); }
  [[nodiscard]] Vec3 linkPosition(int link) const {
    return fromBullet(arm().localPosToWorld(link, btVector3(0, 0, 0)));
  }
  /// Mass, place and velocities of the base or a link.
  struct Motion {
    double mass;
    Vec3 inertia, p_W, v_W, w_W, w_B;
  };
  [[nodiscard]] std::vector<Motion> motions() const {
    const btMultiBody& body = arm();
    const auto count = static_cast<std::size_t>(body.getNumLinks()) + 1;
    std::vector<btVector3> omega(count), vel(count);
    body.compTreeLinkVelocities(omega.data(), vel.data());
    std::vector<Motion> all;
    for (int i = body.hasFixedBase() ? 0 : -1; i < body.getNumLinks(); ++i) {
      const auto at = static_cast<std::size_t>(i + 1);
      const btScalar mass = i < 0 ? body.getBaseMass() : body.getLinkMass(i);
      const btVector3& inertia = i < 0 ? body.getBaseInertia() : body.getLinkInertia(i);
      all.push_back({static_cast<double>(mass), fromBullet(inertia), linkPosition(i),
                     fromBullet(body.localDirToWorld(i, vel[at])),
                     fromBullet(body.localDirToWorld(i, omega[at])), fromBullet(omega[at])});
    }
    return all;
  }
  /// Kinetic and potential energy of base and links [J].
  [[nodiscard]] double energy() const {
    double sum = 0.0;
    for (const Motion& link : motions())
      sum += 0.5 * link.mass * link.v_W.squaredNorm() +
             0.5 * link.w_B.dot(link.inertia.cwiseProduct(link.w_B)) +
             link.mass * kGravity * link.p_W.z();
    return sum;
  }
  void step(double dt) { host.world->stepSimulation(static_cast<btScalar>(dt), 0); }
  void run(double duration, double rate) {
    for (int i = 0; i < static_cast<int>(std::lround(duration * rate)); ++i) step(1.0 / rate);
  }

  AnyHost host;
  FakeDevice device{Vec3(10.0, 0.0, 0.0)};
  std::vector<std::unique_ptr<btMultiBody>> others;  ///< multi-bodies beside arm()
  std::vector<std::unique_ptr<btMultiBodyConstraint>> constraints;
  std::unique_ptr<Site> site;
};

/// What a host that asks for feedback of the first joint reads after a second.
[[nodiscard]] inline btSpatialForceVector runForFeedback(ArmHost& host, double rate,
                                                         bool has_site) {
  btMultiBodyJointFeedback feedback;
  host.arm().getLink(0).m_jointFeedback = &feedback;
  host.putHandBeside();
  if (has_site) host.start();
  host.run(1.0, rate);
  host.arm().getLink(0).m_jointFeedback = nullptr;
  return feedback.m_reactionForces;
}

/// True if both are the same but for the swing of Bullet's first steps, a fiftieth.
[[nodiscard]] inline bool areAlike(const btSpatialForceVector& one,
                                   const btSpatialForceVector& other) {
  const auto are = [](const btVector3& a, const btVector3& b) {
    return (a - b).length() < btScalar(0.02) * a.length();
  };
  return are(one.m_topVec, other.m_topVec) && are(one.m_bottomVec, other.m_bottomVec);
}

inline constexpr double kLink = 0.2, kMass = 0.5;  ///< of a chain's link [m, kg]

/// A chain of equal links along x, about y.
[[nodiscard]] inline std::vector<ArmLinkPlan> makeChain(std::size_t count) {
  std::vector<ArmLinkPlan> plan(count);
  for (std::size_t i = 1; i < count; ++i) plan[i].e = Vec3(0.1, 0.0, 0.0);
  return plan;
}

}  // namespace tandem::test
