// Bullet's examples of multi-bodies. The set-ups by a robotics server, with files, are not here.

#include <algorithm>

#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include "host/example_scenes.h"

namespace tandem::test {
namespace {

constexpr int kMovingGroup = btBroadphaseProxy::DefaultFilter;
constexpr int kMovingMask = btBroadphaseProxy::AllFilter;
constexpr int kStandingGroup = btBroadphaseProxy::StaticFilter;
constexpr int kStandingMask = btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter;
const btQuaternion kStraight(0, 0, 0, 1);

btVector3 inertiaOf(const btCollisionShape& shape, double mass) {
  btVector3 inertia;
  shape.calculateLocalInertia(num(mass), inertia);
  return inertia;
}

void removeDamping(btMultiBody& body) {
  body.setCanSleep(false);
  body.setHasSelfCollision(false);
  body.setUseGyroTerm(false);
  body.setLinearDamping(0);
  body.setAngularDamping(0);
}

void buildPendulum(ExampleHost& host) {
  host.makeWorld(WorldKind::kMultiBody, at(0, -9.81, 0));
  auto& shape = host.keep<btSphereShape>(num(0.05));
  btMultiBody& body = host.addMultiBody(1, 0.0, at(0, 0, 0), true);
  body.setBaseWorldTransform(btTransform::getIdentity());
  body.setupRevolute(0, 10, inertiaOf(shape, 10.0), -1, kStraight, at(1, 0, 0), at(0, 0, 0),
                     at(0, -0.5, 0), false);
  host.finish(body);
  removeDamping(body);
  host.addCollider(body, 0, shape, kMovingGroup, kMovingMask);
  ExampleHost::placeColliders(body);
  host.before = [&body](int) { body.addJointTorque(0, 20); };
}

/// A bar on a hinge with a ball fixed to it, on a base that hangs in the world.
struct BarAndBall {
  btVector3 bar, base, p_W;  // half extents [m], place
  double base_mass, bar_mass, bar_angle;
  btVector3 to_ball, ball_pivot;
};

btMultiBody& addBarAndBall(ExampleHost& host, const BarAndBall& of) {
  btBoxShape& bar = host.keep<btBoxShape>(of.bar);
  btBoxShape& base = host.keep<btBoxShape>(of.base);
  auto& ball = host.keep<btSphereShape>(num(0.2));
  const btVector3 inertia = of.base_mass > 0.0 ? inertiaOf(base, of.base_mass) : at(0, 0, 0);
  btMultiBody& body = host.addMultiBody(2, of.base_mass, inertia, true);
  body.setBaseWorldTransform(pose(of.p_W));
  const btVector3 half(0, -of.bar.y(), 0);
  body.setupRevolute(0, num(of.bar_mass), inertiaOf(bar, of.bar_mass), -1, kStraight, at(1, 0, 0),
                     half, half, false);
  body.setupFixed(1, 1, inertiaOf(ball, 1.0), 0, kStraight, of.to_ball - of.ball_pivot,
                  of.ball_pivot);
  for (int link = 0; link < 2; ++link)
    body.getLink(link).m_jointFeedback = &host.keep<btMultiBodyJointFeedback>();
  host.finish(body);
  removeDamping(body);
  if (of.bar_angle != 0.0) {
    btScalar angle = num(of.bar_angle);
    body.setJointPosMultiDof(0, &angle);
  }
  auto& info = host.world().getSolverInfo();
  info.m_jointFeedbackInWorldSpace = true;
  info.m_jointFeedbackInJointFrame = true;
  auto& collider = host.addCollider(body, -1, base, kStandingGroup, kStandingMask);
  host.addCollider(body, 0, bar, kMovingGroup, kMovingMask);
  host.addCollider(body, 1, ball, kMovingGroup, kMovingMask);
  ExampleHost::placeColliders(body);
  // The examples turn the base's collider; the first step puts it straight.
  collider.setWorldTransform(pose(of.p_W, turn(at(0, 0, 1), 0.25 * SIMD_PI)));
  return body;
}

void buildInvertedPendulum(ExampleHost& host) {
  host.makeWorld(WorldKind::kMultiBody, at(0, -10, 0));
  host.most_sub_steps = 0;
  btMultiBody& body = addBarAndBall(host, {at(0.05, 0.37, 0.1), at(0.04, 0.35, 0.08), at(1, 2, 3),
                                           0.0, 1.0, SIMD_PI, at(0, -0.4, 0), at(0, -0.2, 0)});
  host.before = [&body, offset = -0.1 * SIMD_PI](int step) mutable {
    if (((step + 1) & 0xff) == 0) offset = -offset;
    const double error = SIMD_PI + offset - double(body.getJointPosMultiDof(0)[0]);
    const double torque = 100.0 * error - 20.0 * double(body.getJointVelMultiDof(0)[0]);
    body.addJointTorque(0, num(std::clamp(torque, -100.0, 100.0)));
  };
}

void buildTestJointTorque(ExampleHost& host) {
  host.makeWorld(WorldKind::kMultiBody, at(0, 0, -10));
  host.dt = 1.0 / 240.0;
  host.most_sub_steps = 0;
  host.addBody(0.0, pose(at(-0.4, 2.5, -0.6)), host.box(1, 1, 0.2)).setFriction(0);
  const btVector3 bar = at(0.05, 0.37, 0.1);
  addBarAndBall(host, {bar, bar, at(-0.4, 3, 0), 1.0, 1.0, 0.0, at(0, -0.4, 0), at(0, -0.2, 0)});
  host.guest_at = at(-0.4, 2, 1);
}

void buildMultiBodyConstraintFeedback(ExampleHost& host) {
  host.makeWorld(WorldKind::kMultiBody, at(0, 0, -10));
  host.dt = 1.0 / 240.0;
  host.most_sub_steps = 0;
  host.addBody(0.0, pose(at(-0.4, 3, -1.1)), host.box(10, 10, 0.2)).setFriction(0);
  const btVector3 bar = at(0.05, 0.5, 0.1);
  btMultiBody& body = addBarAndBall(
      host, {bar, bar, at(-0.4, 3, 0), 0.01, 0.0001, 0.0, at(0, -0.5, 0), at(0, 0, 0)});
  host.add(std::make_unique<btMultiBodyJointMotor>(&body, 0, num(0), num(100000)));
  host.guest_at = at(-0.4, 1, 1);
}

/// Five bars on ball joints, from a base that is one more of them.
btMultiBody& addBallChain(ExampleHost& host, const btVector3& p_W, double degrees, bool sleeps) {
  constexpr int kLinks = 5;
  btBoxShape& bar = host.box(0.05, 0.37, 0.1);
  const btVector3 inertia = inertiaOf(bar, 1.0), half = at(0, -0.37, 0);
  btMultiBody& body = host.addMultiBody(kLinks, 1.0, inertia, true);
  body.setBasePos(p_W);
  body.setWorldToBaseRot(kStraight);
  for (int link = 0; link < kLinks; ++link)
    body.setupSpherical(link, 1, inertia, link - 1, kStraight, half, half, true);
  host.finish(body);
  body.setCanSleep(sleeps);
  body.setHasSelfCollision(true);
  body.setUseGyroTerm(true);
  body.setLinearDamping(num(0.1));
  body.setAngularDamping(num(0.9));
  const btVector3 axis = at(1, 1, 0).normalized();
  body.setJointPosMultiDof(0, static_cast<const btScalar*>(turn(axis, degrees * SIMD_PI / 180)));
  for (int link = -1; link < kLinks; ++link)
    host.addCollider(body, link, bar, 2, 1 + 2).setFriction(1);
  ExampleHost::placeColliders(body);
  return body;
}

void beginChains(ExampleHost& host, double cfm) {
  host.makeWorld(WorldKind::kMultiBody, at(0, -9.81, 0));
  host.most_sub_steps = 10;
  host.fixed_step = 1.0 / 240.0;
  host.world().getSolverInfo().m_globalCfm = num(cfm);
}

void buildMultiDof(ExampleHost& host) {
  beginChains(host, 1e-3);
  addBallChain(host, at(-0.4, 3, 0), 45, false);
  host.addBody(0.0, pose(at(0, -51.55, 0)), host.box(50, 50, 50), 1, 1 + 2);
  host.offer(host.addBody(1.0, pose(at(0, 0, 0)), host.box(0.5, 0.5, 0.5)));
}

void buildSerialChains(ExampleHost& host) {
  beginChains(host, 1e-4);
  addBallChain(host, at(-0.4, 3, 0), 45, true);
  addBallChain(host, at(-0.4, 3, 0.5), -45, true);
  for (int i = 0; i < 2; ++i)  // the example adds its floor twice
    host.addBody(0.0, pose(at(0, -51.55, 0)), host.box(50, 50, 50), 1, 1 + 2);
  host.guest_at = at(1, 0, 0.25);
}

void buildMultiBodySoftContact(ExampleHost& host) {
  host.makeWorld(WorldKind::kMultiBody, at(0, 0, -10));
  host.addBody(0.0, pose(at(0, 0, -50.5)), host.box(50, 50, 50))
      .setContactStiffnessAndDamping(300, 10);
  auto& ball = host.keep<btSphereShape>(num(0.5));
  btMultiBody& body = host.addMultiBody(0, 1.0, inertiaOf(ball, 1.0), false);
  body.setBaseWorldTransform(pose(at(0, 0, 3)));
  host.addCollider(body, -1, ball, kMovingGroup, kMovingMask);
  host.finish(body);
  ExampleHost::placeColliders(body);
  host.guest_at = at(0.3, 0, 4.5);
}

}  // namespace

std::vector<ExampleScene> multiBodyScenes() {
  return {{"Pendulum", buildPendulum},
          {"InvertedPendulumPDControl", buildInvertedPendulum},
          {"TestJointTorqueSetup", buildTestJointTorque},
          {"MultiBodyConstraintFeedback", buildMultiBodyConstraintFeedback},
          {"MultiDofDemo", buildMultiDof},
          {"SerialChains", buildSerialChains},
          {"MultiBodySoftContact", buildMultiBodySoftContact}};
}

}  // namespace tandem::test
