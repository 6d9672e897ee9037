// Joints that ask for what bodies can hardly give: contradictions, locked axes, weak motors, blows.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/coordination/island_counters.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "physics/joint_host.h"

namespace tandem {
namespace {

using test::byWidth;
using test::JointHost;

constexpr double kGravity = JointHost::kGravity;
constexpr double kLength = JointHost::kLength, kMass = JointHost::kMass;

const Vec3 kLeft(-0.5 * kLength, 0.0, 0.0), kRight(0.5 * kLength, 0.0, 0.0);

// A bridge of planks whose pins are open at first, as in Bullet's example: no motion closes all of
// them at once. The solver tried for ever, 12 ms in each tick.
TEST(HostJoints, ThatContradictEachOtherDoNotHoldTheSolverUp) {
  constexpr int kPlanks = 8;
  constexpr double kSpacing = 0.17;
  JointHost host;
  for (int i = 0; i < kPlanks; ++i) {
    const bool is_end = i == 0 || i == kPlanks - 1;
    btRigidBody& plank = host.addLink(Vec3(i * kSpacing, 0.0, 0.0), is_end ? 0.0 : 1.0);
    if (i == 0) continue;
    for (const double y : {-0.02, 0.02})
      host.join<btPoint2PointConstraint>(*host.links[static_cast<std::size_t>(i - 1)], plank,
                                         toBullet(Vec3(kRight + Vec3(0.0, y, 0.0))),
                                         toBullet(Vec3(kLeft + Vec3(0.0, y, 0.0))));
  }
  btRigidBody& middle = *host.links[kPlanks / 2];
  host.share(middle);
  for (int i = 0; i < 180; ++i) host.rig.step(1.0 / 60.0);
  const IslandCounters& counters = host.site->islandCounters();
  std::printf("%.2f factors a step, %d advances cut short\n",
              static_cast<double>(counters.rigid_factorisations) /
                  static_cast<double>(counters.rigid_steps),
              static_cast<int>(counters.rigid_bounded));
  EXPECT_GT(counters.rigid_steps, 1000u);
  EXPECT_LT(counters.rigid_factorisations, 4 * counters.rigid_steps);
  EXPECT_LT(static_cast<double>(middle.getLinearVelocity().norm()), 5.0);
}

// Planar bodies that are tilted out of their plane by a hair can hardly move there. A joint that
// wants them to would need 1e8 N s, and kick all that hangs on it.
TEST(HostJoints, AskNothingOfAPlanarBodyOutOfItsPlane) {
  JointHost host;
  for (int i = 0; i < 3; ++i) {
    btRigidBody& link = host.addLink(Vec3((i + 0.5) * kLength, i * 2e-4, 0.0));
    link.setWorldTransform(toBullet(Vec3((i + 0.5) * kLength, i * 2e-4, 0.0),
                                    test::turn(1e-5 * (1 + i), Vec3(1.0, 0.3, 0.7))));
    link.setInterpolationWorldTransform(link.getWorldTransform());
    link.setLinearFactor(btVector3(1, 0, 1));
    link.setAngularFactor(btVector3(0, 1, 0));
    if (i == 0)
      host.join<btHingeConstraint>(link, toBullet(kLeft), btVector3(0, 1, 0));
    else
      host.join<btHingeConstraint>(*host.links[static_cast<std::size_t>(i - 1)], link,
                                   toBullet(kRight), toBullet(kLeft), btVector3(0, 1, 0),
                                   btVector3(0, 1, 0));
  }
  host.share(*host.links[1]);
  const double before = host.energy(), unit = 3.0 * kMass * kGravity * kLength;
  for (int i = 0; i < 120; ++i) {
    host.rig.step(1.0 / 60.0);
    ASSERT_LT(host.energy() - before, 1e-3 * unit) << i;
  }
  EXPECT_LT(static_cast<double>(host.links[2]->getLinearVelocity().norm()), 10.0);
}

// A host moves bodies along locked axes as their joint forbids. What can move was thrown to and fro
// to make up for it: at 55 m/s. Once its joint is 6 degrees oblique, it may go ten times as fast as
// the host's way there.
TEST(HostJoints, ThrowNothingThatIsMovedAlongLockedAxes) {
  JointHost host;
  host.rig.world.setGravity(btVector3(0, 0, 0));
  btRigidBody& figure = host.addLink(Vec3::Zero());
  btRigidBody& slide = host.addLink(Vec3(0.25, 0.0, 0.0));
  for (btRigidBody* link : {&figure, &slide}) link->setLinearFactor(btVector3(1, 0, 1));
  figure.setAngularFactor(btVector3(0, 0, 0));
  slide.setAngularFactor(btVector3(0, 1, 0));
  btTransform in_figure = btTransform::getIdentity(), in_slide = in_figure;
  in_figure.setOrigin(toBullet(Vec3(0.125, 0.0, 0.0)));
  in_slide.setOrigin(toBullet(Vec3(-0.125, 0.0, 0.0)));
  host.join<btSliderConstraint>(figure, slide, in_figure, in_slide, true);
  host.share(figure);
  figure.setLinearVelocity(toBullet(Vec3(0.3, -0.4, 0.95)));
  figure.setAngularVelocity(toBullet(Vec3(12.9, 9.2, -7.0)));
  double fastest = 0.0;
  for (int i = 0; i < 60; ++i) {
    host.rig.step(1e-3);
    for (const btRigidBody* link : host.links)
      fastest = std::max(fastest, fromBullet(link->getLinearVelocity()).norm());
  }
  // The joint goes at 17 rad/s and 0.125 m from the figure.
  EXPECT_LT(fastest, 10.0 * (0.4 + 17.3 * 0.125));
}

// Weak motors on six legs: Newton's steps took some from their lower bound to the upper one and
// back, for ever.
TEST(HostJoints, WhoseMotorsAreWeakSettle) {
  JointHost host;
  btRigidBody& middle = host.addLink(Vec3::Zero(), 0.0);
  for (int i = 0; i < 6; ++i) {
    const Quat q = test::turn(i * M_PI / 3.0, Vec3::UnitZ());
    btRigidBody* parent = &middle;
    for (int part = 0; part < 2; ++part) {
      btRigidBody& link = host.addLink(q * Vec3(0.2 + part * kLength, 0.0, 0.0), 1.0);
      link.getWorldTransform().setRotation(toBullet(q));
      link.setInterpolationWorldTransform(link.getWorldTransform());
      host.rig.world.removeRigidBody(&link);
      host.rig.world.addRigidBody(&link, 2, 0);  // legs do not touch each other
      const Vec3 pin_W = q * Vec3(0.1 + part * kLength, 0.0, 0.0), axis_W = q * Vec3::UnitY();
      const auto seenFrom = [&](const btRigidBody& body, const Vec3& v, double w) {
        const btTransform inverse = body.getWorldTransform().inverse();
        return w > 0.0 ? btVector3(inverse * toBullet(v)) : inverse.getBasis() * toBullet(v);
      };
      auto& hinge = host.join<btHingeConstraint>(
          *parent, link, seenFrom(*parent, pin_W, 1.0), seenFrom(link, pin_W, 1.0),
          seenFrom(*parent, axis_W, 0.0), seenFrom(link, axis_W, 0.0));
      hinge.setLimit(btScalar(-0.6), btScalar(0.4));
      hinge.enableAngularMotor(true, btScalar(part == 0 ? 3.0 : -5.0), btScalar(0.03));
      parent = &link;
    }
  }
  host.links.erase(host.links.begin());
  host.share(*host.links[0]);
  for (int i = 0; i < 120; ++i) {
    host.rig.step(1.0 / 60.0);
    if (i % 20 != 10) continue;
    for (const auto& joint : host.joints) {
      auto& hinge = static_cast<btHingeConstraint&>(*joint);
      hinge.enableAngularMotor(true, -hinge.getMotorTargetVelocity(), btScalar(0.03));
    }
  }
  const IslandCounters& counters = host.site->islandCounters();
  std::printf("%.2f factors a step, %d advances cut short\n",
              static_cast<double>(counters.rigid_factorisations) /
                  static_cast<double>(counters.rigid_steps),
              static_cast<int>(counters.rigid_bounded));
  EXPECT_LT(counters.rigid_factorisations, 5 * counters.rigid_steps);
  for (const btRigidBody* link : host.links)
    EXPECT_LT(static_cast<double>(link->getLinearVelocity().norm()), 20.0);
}

// A blow makes a body go round its pin by radians within a haptic period. Its forces were
// integrated in steps of a quarter period, whatever the error.
TEST(HostJoints, CloseAgainWhenABlowTurnsThemByRadiansInAHapticPeriod) {
  constexpr double kArm = 0.11;                         // [m]
  for (const double rate : {2000.0, 4000.0, 6000.0}) {  // [rad/s]
    JointHost host;
    host.rig.world.setGravity(btVector3(0, 0, 0));
    btCollisionShape& shape = host.rig.makeShape<btCapsuleShapeZ>(btScalar(0.016), btScalar(0.03));
    btRigidBody& body = host.add(shape, 0.25, Vec3(kArm, 0.0, 0.0));
    host.join<btPoint2PointConstraint>(body, toBullet(Vec3(-kArm, 0.0, 0.0)));
    host.share(body);
    const Vec3 w_W = rate * Vec3(0.0, 0.6, 0.8);
    body.setLinearVelocity(toBullet(w_W.cross(Vec3(kArm, 0.0, 0.0))));
    body.setAngularVelocity(toBullet(w_W));
    const double before = host.energy();
    for (int i = 0; i < 24; ++i) host.rig.step(1.0 / 240.0);
    EXPECT_LT(JointHost::gap(body, Vec3(-kArm, 0.0, 0.0), Vec3::Zero()), byWidth(1e-9, 1e-5));
    EXPECT_LT(host.energy(), 1.001 * before) << rate;
  }
}

}  // namespace
}  // namespace tandem
