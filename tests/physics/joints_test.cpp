// Bodies in Bullet's joints, shared and near the hand: as exact as a body alone, at any host rate.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "physics/joint_host.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::byWidth;
using test::JointHost;

constexpr double kGravity = JointHost::kGravity;
constexpr double kLength = JointHost::kLength, kWidth = JointHost::kWidth, kMass = JointHost::kMass;

const Vec3 kLeft(-0.5 * kLength, 0.0, 0.0), kRight(0.5 * kLength, 0.0, 0.0);

class JointsAtRates : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(HostRates, JointsAtRates, ::testing::Values(60.0, 240.0, 1000.0));

// A link falls from the horizontal about a hinge and swings.
TEST_P(JointsAtRates, ASharedPendulumKeepsItsEnergyAndItsPin) {
  JointHost host;
  btRigidBody& link = host.addLink(Vec3(0.5 * kLength, 0.0, 0.0));
  host.join<btHingeConstraint>(link, toBullet(kLeft), btVector3(0, 1, 0));
  host.share(link);
  const double before = host.energy(), unit = kMass * kGravity * kLength;
  double most = 0.0, least = 0.0, off = 0.0;
  for (int i = 0; i < static_cast<int>(20.0 * GetParam()); ++i) {
    host.rig.step(1.0 / GetParam());
    most = std::max(most, host.energy() - before);
    least = std::min(least, host.energy() - before);
    off = std::max(off, JointHost::gap(link, kLeft, Vec3::Zero()));
  }
  EXPECT_LT(most, byWidth(1e-7, 1e-4) * unit);
  EXPECT_GT(least, -byWidth(1e-7, 1e-4) * unit);
  EXPECT_LT(off, byWidth(1e-9, 1e-6));
}

// The first of three links is shared: the others come with it. Later they would hit each other.
TEST_P(JointsAtRates, AChainOfNeighboursSwingsAsOne) {
  JointHost host;
  for (int i = 0; i < 3; ++i) {
    btRigidBody& link = host.addLink(Vec3(kLength * (i + 0.5), 0.0, 0.0));
    if (i == 0)
      host.join<btPoint2PointConstraint>(link, toBullet(kLeft));
    else
      host.join<btPoint2PointConstraint>(link, *host.links[static_cast<std::size_t>(i - 1)],
                                         toBullet(kLeft), toBullet(kRight));
  }
  host.share(*host.links[0]);
  const double before = host.energy(), unit = kMass * kGravity * kLength;
  double worst = 0.0, off = 0.0;
  for (int i = 0; i < static_cast<int>(GetParam()); ++i) {
    host.rig.step(1.0 / GetParam());
    worst = std::max(worst, std::abs(host.energy() - before));
    off = std::max({off, JointHost::gap(*host.links[0], kLeft, Vec3::Zero()),
                    JointHost::gap(*host.links[1], kLeft, *host.links[0], kRight),
                    JointHost::gap(*host.links[2], kLeft, *host.links[1], kRight)});
  }
  EXPECT_EQ(host.site->counters().promoted, 2U);
  EXPECT_LT(worst, byWidth(1e-6, 1e-3) * unit);
  EXPECT_LT(off, byWidth(1e-9, 2e-6));
}

TEST_P(JointsAtRates, ALoadedJointDoesNotSag) {
  JointHost host;
  btRigidBody& link = host.addLink(Vec3(0.5 * kLength, 0.0, 0.0), 5.0);
  btTransform frame = btTransform::getIdentity();
  frame.setOrigin(toBullet(kLeft));
  host.join<btFixedConstraint>(link, btTypedConstraint::getFixedBody(), frame,
                               btTransform::getIdentity());
  host.share(link);
  for (int i = 0; i < static_cast<int>(2.0 * GetParam()); ++i) host.rig.step(1.0 / GetParam());
  EXPECT_LT(JointHost::gap(link, kLeft, Vec3::Zero()), byWidth(1e-9, 1e-7));
  EXPECT_LT(JointHost::gap(link, kRight, Vec3(kLength, 0.0, 0.0)), byWidth(1e-9, 1e-6));
}

// Ticks of the host's step have run when its torque comes: its way since is that of the joint.
TEST_P(JointsAtRates, WhereTheCallerTicksAPinAnswersAHostsBlowAtOnce) {
  JointHost host;
  btRigidBody& first = host.addLink(Vec3(0.5 * kLength, 0.0, 0.0));
  btRigidBody& last = host.addLink(Vec3(1.5 * kLength, 0.0, 0.0), 0.1 * kMass);
  const btVector3 axis(0, 1, 0);
  host.join<btHingeConstraint>(first, toBullet(kLeft), axis);
  host.join<btHingeConstraint>(last, first, toBullet(kLeft), toBullet(kRight), axis, axis);
  SiteSettings settings;
  settings.tick_source = TickSource::kCaller;
  settings.host_step = 1.0 / GetParam();
  host.share(first, settings);
  double fastest = 0.0, off = 0.0;
  int ticks = 0;
  for (int i = 0; i < static_cast<int>(0.5 * GetParam()); ++i) {
    for (; ticks * 1e-3 < (i + 1) / GetParam() - 1e-9; ++ticks) host.site->tick(ticks * 1e-3);
    // The pins take all of it. One that changes acts as a blow.
    last.applyTorque(btVector3(btScalar(0.3), 0, btScalar(i % 2 == 0 ? 1 : -1)));
    host.rig.step(1.0 / GetParam());
    for (const btRigidBody* link : host.links) {
      const btVector3& w = link->getAngularVelocity();
      fastest = std::max(fastest, static_cast<double>(std::hypot(w.x(), w.z())));
    }
    off = std::max({off, JointHost::gap(first, kLeft, Vec3::Zero()),
                    JointHost::gap(last, kLeft, first, kRight)});
  }
  EXPECT_LT(fastest, byWidth(1e-6, 1e-3));
  EXPECT_LT(off, byWidth(1e-6, 1e-5));
}

TEST_P(JointsAtRates, ADoorRestsAtItsStop) {
  JointHost host;
  btRigidBody& link = host.addLink(Vec3(0.5 * kLength, 0.0, 0.0));
  auto& hinge = host.join<btHingeConstraint>(link, toBullet(kLeft), btVector3(0, 1, 0));
  hinge.setLimit(btScalar(-0.5), btScalar(0.5));
  host.share(link);
  double farthest = 0.0;
  for (int i = 0; i < static_cast<int>(3.0 * GetParam()); ++i) {
    host.rig.step(1.0 / GetParam());
    farthest = std::max(farthest, std::abs(static_cast<double>(hinge.getHingeAngle())));
  }
  EXPECT_LT(farthest, 0.5 + byWidth(1e-7, 1e-5));
  EXPECT_NEAR(std::abs(static_cast<double>(hinge.getHingeAngle())), 0.5, byWidth(1e-7, 1e-5));
  EXPECT_LT(fromBullet(link.getAngularVelocity()).norm(), byWidth(1e-7, 1e-5));
}

TEST_P(JointsAtRates, AMotorDrivesADrawer) {
  constexpr double kSpeed = 0.7, kForce = 5.0;  // [m/s], [N]
  JointHost host;
  btRigidBody& drawer = host.addLink(Vec3::Zero());
  auto& slider = host.join<btSliderConstraint>(drawer, btTransform::getIdentity(), true);
  slider.setLowerLinLimit(-10);
  slider.setUpperLinLimit(10);
  slider.setPoweredLinMotor(true);
  slider.setTargetLinMotorVelocity(btScalar(kSpeed));
  slider.setMaxLinMotorForce(btScalar(kForce));
  host.share(drawer);
  for (int i = 0; i < static_cast<int>(std::lround(GetParam())); ++i)
    host.rig.step(1.0 / GetParam());
  const double until = kSpeed * 0.5 * kMass / kForce;  // its copy has half of the mass
  const double x = static_cast<double>(drawer.getWorldTransform().getOrigin().x());
  EXPECT_NEAR(std::abs(x), kSpeed * (1.0 - 0.5 * until), byWidth(1e-5, 2e-5));
  EXPECT_NEAR(std::abs(static_cast<double>(drawer.getLinearVelocity().x())), kSpeed,
              byWidth(1e-9, 1e-5));
}

// The pin of a place that has moved is open, and pulls the link that hangs on it.
TEST_P(JointsAtRates, ABoundedPinPullsALinkAtItsOwnPoint) {
  JointHost host;
  btRigidBody& link = host.addLink(Vec3::Zero());
  auto& pin = host.join<btPoint2PointConstraint>(link, btVector3(0, 0, 0));
  pin.m_setting.m_impulseClamp = btScalar(1.0);
  host.share(link);
  host.rig.step(1.0 / GetParam());
  pin.setPivotB(btVector3(btScalar(0.05), 0, 0));
  double turning = 0.0;
  for (int i = 0; i < static_cast<int>(GetParam()); ++i) {
    host.rig.step(1.0 / GetParam());
    turning = std::max(turning, fromBullet(link.getAngularVelocity()).norm());
  }
  EXPECT_LT(turning, byWidth(1e-9, 1e-4));
  EXPECT_LT(JointHost::gap(link, Vec3::Zero(), Vec3(0.05, 0.0, 0.0)), 1e-4);
}

TEST(HostJoints, AreOnForTheHostAndEndWithItsOrder) {
  JointHost host;
  btRigidBody& link = host.addLink(Vec3(0.5 * kLength, 0.0, 0.0));
  auto& hinge = host.join<btHingeConstraint>(link, toBullet(kLeft), btVector3(0, 1, 0));
  host.share(link);
  for (int i = 0; i < 10; ++i) {
    host.rig.step(1.0 / 60.0);
    EXPECT_TRUE(hinge.isEnabled());
  }
  hinge.setEnabled(false);
  const double v = static_cast<double>(link.getLinearVelocity().z());
  for (int i = 0; i < 6; ++i) host.rig.step(1.0 / 60.0);
  EXPECT_FALSE(hinge.isEnabled());
  // The island was up to a tick ahead.
  EXPECT_NEAR(static_cast<double>(link.getLinearVelocity().z()), v - kGravity * 0.1,
              1e-3 * kGravity);
  hinge.setEnabled(true);
  for (int i = 0; i < 60; ++i) host.rig.step(1.0 / 60.0);
  EXPECT_LT(JointHost::gap(link, kLeft, Vec3::Zero()), 1e-3);
  host.rig.world.removeConstraint(&hinge);
  host.joints.clear();
  for (int i = 0; i < 60; ++i) host.rig.step(1.0 / 60.0);
  EXPECT_LT(static_cast<double>(link.getLinearVelocity().z()), -5.0);
}

TEST_P(JointsAtRates, TheHostReadsForcesAndBreaksWhatIsTooWeak) {
  JointHost host;
  btRigidBody& link = host.addLink(Vec3(0.5 * kLength, 0.0, 0.0), 2.0);
  btTransform frame = btTransform::getIdentity();
  frame.setOrigin(toBullet(kLeft));
  auto& joint = host.join<btFixedConstraint>(link, btTypedConstraint::getFixedBody(), frame,
                                             btTransform::getIdentity());
  btJointFeedback feedback;
  joint.setJointFeedback(&feedback);
  host.share(link);
  const double dt = 1.0 / GetParam();
  for (int i = 0; i < 4; ++i) host.rig.step(dt);
  // The copy has half of the mass.
  EXPECT_NEAR(static_cast<double>(feedback.m_appliedForceBodyA.z()), kGravity, 1e-3);
  EXPECT_NEAR(static_cast<double>(feedback.m_appliedForceBodyB.z()), -kGravity, 1e-3);
  // About the centre of mass.
  EXPECT_NEAR(static_cast<double>(feedback.m_appliedTorqueBodyA.y()), 0.0, 1e-3);
  // Bullet breaks a joint by the impulse of a step.
  joint.setBreakingImpulseThreshold(static_cast<btScalar>(1.2 * kGravity * dt));
  for (int i = 0; i < 4; ++i) host.rig.step(dt);
  EXPECT_TRUE(joint.isEnabled());
  for (int i = 0; i < 4; ++i) {
    link.applyCentralForce(btVector3(0, 0, -20));
    host.rig.step(dt);
  }
  EXPECT_FALSE(joint.isEnabled());
}

// A body hangs at rest, and all sleeps: the host's changes are noticed all the same.
TEST(HostJoints, WakeWhenTheHostChangesThem) {
  for (const bool is_removed : {false, true}) {
    JointHost host;
    btRigidBody& link = host.addLink(Vec3(0.0, 0.0, -0.1));
    const btVector3 pin_B(0, 0, btScalar(0.1));
    auto& hinge = host.join<btHingeConstraint>(link, pin_B, btVector3(0, 1, 0));
    host.share(link);
    for (int i = 0; i < 60; ++i) host.rig.step(1.0 / 60.0);
    EXPECT_GT(host.site->counters().host_steps_skipped, 0U);
    if (is_removed)
      host.rig.world.removeConstraint(&hinge);
    else
      hinge.enableAngularMotor(true, 1, btScalar(0.1));
    for (int i = 0; i < 12; ++i) host.rig.step(1.0 / 60.0);
    if (is_removed)
      EXPECT_LT(static_cast<double>(link.getLinearVelocity().z()), -1.5);
    else
      EXPECT_NEAR(std::abs(static_cast<double>(link.getAngularVelocity().y())), 1.0,
                  byWidth(1e-9, 1e-5));
    if (is_removed) host.joints.clear();
  }
}

TEST(HostJoints, ThatStayBulletsAreTold) {
  JointHost host;
  btRigidBody& link = host.addLink(Vec3(0.5 * kLength, 0.0, 0.0));
  btRigidBody& next = host.addLink(Vec3(1.5 * kLength, 0.0, 0.0));
  host.join<btPoint2PointConstraint>(link, next, toBullet(kRight), toBullet(kLeft));
  SiteSettings settings;
  settings.max_neighbours = 1;
  host.share(link, settings);
  host.rig.step(1.0 / 60.0);
  EXPECT_TRUE(host.site->warnings().empty());
  host.addLink(Vec3(2.5 * kLength, 0.0, 0.0));
  host.join<btPoint2PointConstraint>(next, *host.links[2], toBullet(kRight), toBullet(kLeft));
  host.rig.step(1.0 / 60.0);
  host.rig.step(1.0 / 60.0);
  ASSERT_EQ(host.site->warnings().size(), 1U);
  EXPECT_NE(host.site->warnings()[0].find("raise max_neighbours"), std::string::npos);
}

// Copies of a pendulum at two sites, 50 ms apart, swing as one alone does.
TEST_P(JointsAtRates, TwoSitesShareAPendulum) {
  constexpr double kDelay = 0.05;
  JointHost hosts[2];
  test::FakeLink links[2] = {test::FakeLink(4096), test::FakeLink(4096)};
  for (int i = 0; i < 2; ++i) {
    btRigidBody& link = hosts[i].addLink(Vec3(0.5 * kLength, 0.0, 0.0));
    hosts[i].join<btHingeConstraint>(link, toBullet(kLeft), btVector3(0, 1, 0));
    SiteSettings settings;
    settings.self = PeerId{static_cast<std::uint32_t>(i) + 1};
    hosts[i].share(link, settings, {50.0, 3.0});
    hosts[i].site->connect(PeerId{static_cast<std::uint32_t>(2 - i)}, links[i], Vec3(0, 15, 5));
  }
  const double before = hosts[0].energy(), unit = kMass * kGravity * kLength;
  double most = 0.0, off = 0.0, apart = 0.0;
  for (int step = 0; step < static_cast<int>(10.0 * GetParam()); ++step) {
    for (int i = 0; i < 2; ++i) {
      hosts[i].rig.step(1.0 / GetParam());
      for (const StatePacket& packet : links[i].sent)
        links[1 - i].arrivals.push_back({packet, packet.time + kDelay});
      links[i].sent.clear();
      most = std::max(most, hosts[i].energy() - before);
      off = std::max(off, JointHost::gap(*hosts[i].links[0], kLeft, Vec3::Zero()));
    }
    apart = std::max(
        apart, JointHost::gap(*hosts[0].links[0], Vec3::Zero(), *hosts[1].links[0], Vec3::Zero()));
  }
  EXPECT_LT(most, 1e-4 * unit);
  EXPECT_LT(off, byWidth(1e-9, 1e-6));
  EXPECT_LT(apart, 1e-6);
}

/// A door that a hand pushes: one degree of freedom, by Runge-Kutta's method in steps of 10 us.
struct DoorReference {
  static constexpr double kDoorMass = 2.0, kRadius = 0.01, kStep = 1e-5;
  static constexpr double kStiffness = 2000.0, kDamping = 5.0;
  double angle = 0.0, speed = 0.0;

  /// Force of the contact for a hand at `p_W` that moves at `v_W`; `turn` about the pin [N, N m].
  static double push(double angle, double speed, const Vec3& p_W, const Vec3& v_W, double* turn) {
    const Vec3 along(std::cos(angle), std::sin(angle), 0.0), up(-along.y(), along.x(), 0.0);
    // The face looks along -up.
    const double overlap = kRadius + up.dot(p_W) + 0.5 * kWidth, reach = along.dot(p_W);
    const double rate = up.dot(v_W) - speed * reach;
    const double force =
        overlap > 0.0 ? std::max(0.0, kStiffness * overlap + kDamping * rate) : 0.0;
    if (turn) *turn = force * reach;
    return force;
  }
  void go(double duration, const Vec3& p_W, const Vec3& v_W) {
    const double inertia = kDoorMass / 12.0 * (kLength * kLength + kWidth * kWidth) +
                           0.25 * kDoorMass * kLength * kLength;
    const int steps = std::max(1, static_cast<int>(std::lround(duration / kStep)));
    const double h = duration / steps;
    for (int i = 0; i < steps; ++i) {
      const auto accelerate = [&](double at, double a, double w) {
        double turn = 0.0;
        push(a, w, p_W + (i * h + at) * v_W, v_W, &turn);
        return turn / inertia;
      };
      const double k1 = accelerate(0.0, angle, speed);
      const double k2 = accelerate(0.5 * h, angle + 0.5 * h * speed, speed + 0.5 * h * k1);
      const double k3 =
          accelerate(0.5 * h, angle + 0.5 * h * (speed + 0.5 * h * k1), speed + 0.5 * h * k2);
      const double k4 = accelerate(h, angle + h * (speed + 0.5 * h * k2), speed + h * k3);
      angle += h * (speed + h / 6.0 * (k1 + k2 + k3));
      speed += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
  }
};

// A hand goes steadily against a door, and feels its inertia about the hinge.
TEST_P(JointsAtRates, AHandFeelsADoor) {
  JointHost host;
  host.rig.world.setGravity(btVector3(0, 0, 0));
  btRigidBody& door = host.addLink(Vec3(0.5 * kLength, 0.0, 0.0), DoorReference::kDoorMass);
  host.join<btHingeConstraint>(door, toBullet(kLeft), btVector3(0, 0, 1));
  const Vec3 v_W(0.0, 0.05, 0.0);
  Vec3 p_W(0.8 * kLength, -0.5 * kWidth - 0.01203, 0.0);
  host.device.sample.hip = {p_W, v_W};
  SiteSettings settings;
  settings.peers = 1;
  settings.contact = {DoorReference::kStiffness, DoorReference::kDamping};
  settings.hip_radius = DoorReference::kRadius;
  settings.max_slew = 1e9;
  settings.tick_source = TickSource::kCaller;
  host.share(door, settings);
  DoorReference reference;
  double off = 0.0, worst = 0.0, most = 0.0;
  const int ticks_per_step = static_cast<int>(std::lround(1000.0 / GetParam()));
  for (int tick = 0; tick < 500; ++tick) {
    const double t = 1e-3 * tick;
    host.site->tick(t);
    const double felt = host.device.force_W.norm();
    const double wanted = DoorReference::push(reference.angle, reference.speed, p_W, v_W, nullptr);
    worst = std::max(worst, std::abs(felt - wanted));
    most = std::max(most, wanted);
    reference.go(1e-3, p_W, v_W);
    p_W += 1e-3 * v_W;
    host.device.sample.hip = {p_W, v_W};
    if ((tick + 1) % ticks_per_step == 0) host.rig.step(1e-3 * ticks_per_step);
    off = std::max(off, JointHost::gap(door, kLeft, Vec3::Zero()));
  }
  EXPECT_GT(most, 1.0);
  EXPECT_LT(worst, byWidth(2e-5, 2e-4) * most);
  EXPECT_LT(off, byWidth(1e-9, 1e-6));
}

}  // namespace
}  // namespace tandem
