// Joints in the island: energy, momentum, stops and motors against closed forms.

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "island/box_scene.h"
#include "island/plain_joints.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::PlainJoints;

constexpr double kTick = 1e-3;                        // [s]
constexpr double kLength = 0.2, kMass = 0.5;          // of a link [m], [kg]
constexpr double kGravity = 9.81;                     // [m/s^2]
constexpr double kWidth = 0.04;                       // of a link [m]
constexpr double kUnit = kMass * kGravity * kLength;  // energy [J]

IslandBody makeLink(const Vec3& p_W) {
  IslandBody link;
  link.shape = Box{{0.5 * kLength, 0.5 * kWidth, 0.5 * kWidth}};
  link.mass = kMass;
  const double across = kWidth * kWidth, along = kLength * kLength;
  link.inertia_B = kMass / 12.0 * Vec3(2.0 * across, along + across, along + across);
  link.start.p_W = p_W;
  return link;
}

/// Links along x, each joined to the one before and the first to the origin.
class Chain {
 public:
  Chain(int count, const Vec3& axis, double tick = kTick) : tick_(tick), island_(settings(tick)) {
    for (int i = 0; i < count; ++i) {
      island_.addBody(makeLink({kLength * (i + 0.5), 0.0, 0.0}));
      PlainJoints::Joint joint;
      joint.at_A = Vec3(-0.5 * kLength, 0.0, 0.0);
      joint.at_B = i == 0 ? Vec3(Vec3::Zero()) : Vec3(0.5 * kLength, 0.0, 0.0);
      joint.axis_A = joint.axis_B = axis;
      joints.add(i, i - 1, joint);
    }
  }
  void start() {
    island_.setJointSource(&joints);
    island_.prepare();
    push(Vec3::Zero());
  }
  /// Weight, and a torque on the first link.
  void push(const Vec3& t_W) {
    for (BodyIndex b = 0; b < island_.bodyCount(); ++b)
      island_.setExternalWrench(b, Vec3(0.0, 0.0, -kMass * kGravity),
                                b == 0 ? t_W : Vec3(Vec3::Zero()));
  }
  void run(double duration) {
    const double before = energy();
    for (int i = 0; i < static_cast<int>(std::lround(duration / tick_)); ++i) {
      island_.advance(tick_);
      most_energy = std::max(most_energy, energy() - before);
      least_energy = std::min(least_energy, energy() - before);
      for (BodyIndex b = 0; b < island_.bodyCount(); ++b) off = std::max(off, pinOff(b));
    }
  }
  [[nodiscard]] double energy() const {
    double sum = 0.0;
    for (BodyIndex b = 0; b < island_.bodyCount(); ++b) {
      const RigidState& state = island_.state(b);
      const Vec3 w_B = state.q_WB.conjugate() * state.w_W;
      sum += 0.5 * kMass * state.v_W.squaredNorm() +
             0.5 * w_B.dot(island_.body(b).inertia_B.cwiseProduct(w_B)) +
             kMass * kGravity * state.p_W.z();
    }
    return sum;
  }
  [[nodiscard]] double pinOff(BodyIndex b) const {
    const RigidState& a = island_.state(b);
    const Vec3 pin_W = a.p_W - a.q_WB * Vec3(0.5 * kLength, 0.0, 0.0);
    if (b == 0) return pin_W.norm();
    const RigidState& before = island_.state(b - 1);
    return (pin_W - before.p_W - before.q_WB * Vec3(0.5 * kLength, 0.0, 0.0)).norm();
  }
  /// Of the first link about an axis [rad].
  [[nodiscard]] double angleAbout(const Vec3& axis) const {
    const Quat& q = island_.state(0).q_WB;
    return 2.0 * std::atan2(q.vec().dot(axis), q.w());
  }
  [[nodiscard]] Island& island() { return island_; }

  PlainJoints joints;
  double most_energy = 0.0, least_energy = 0.0;  ///< beside the start [J]
  double off = 0.0;                              ///< largest gap of a pin [m]

 private:
  static IslandSettings settings(double tick) {
    IslandSettings settings;
    settings.haptic_period = tick;
    return settings;
  }

  double tick_;
  Island island_;
};

TEST(IslandJoints, KeepThePendulumsEnergyForAMinute) {
  Chain door(1, Vec3::UnitY());
  door.start();
  door.run(60.0);
  EXPECT_LT(door.most_energy, 1e-8 * kUnit);
  EXPECT_GT(door.least_energy, -1e-8 * kUnit);
  EXPECT_LT(door.off, 1e-10);
}

TEST(IslandJoints, AreSolvedAgainOnlyWhereSmoothMotionHasNotAnsweredThem) {
  Chain chain(1, Vec3::UnitY());
  chain.start();
  chain.run(2.0);
  const IslandCounters before = chain.island().counters();
  EXPECT_GE(before.rigid_steps, 2000u);
  EXPECT_LT(before.rigid_factorisations, before.rigid_steps / 4);
  RigidState struck = chain.island().state(0);
  struck.v_W.y() += 1.0;
  chain.island().setState(0, struck);
  chain.run(0.001);
  EXPECT_GT(chain.island().counters().rigid_factorisations, before.rigid_factorisations);
  EXPECT_LT(chain.off, 1e-9);
}

// A stiff contact pushes a link of some grams so hard. Its joint gave up, and impulses at the ends
// of steps did what they could.
TEST(IslandJoints, KeepAPendulumsEnergyUnderAnyLoad) {
  for (const double load : {1e2, 1e4, 3e6}) {  // [m/s^2]
    Chain chain(1, Vec3::UnitY());
    chain.start();
    chain.island().setExternalWrench(0, kMass * load * Vec3::UnitX(), Vec3::Zero());
    const double radius = 0.5 * kLength, swing = 0.1 * std::sqrt(load / radius);
    RigidState state = chain.island().state(0);
    state.w_W = Vec3(0.0, swing, 0.0);
    state.v_W = state.w_W.cross(Vec3(radius, 0.0, 0.0));
    chain.island().setState(0, state);
    const auto energyOf = [&] {
      return chain.energy() - kMass * (load * chain.island().state(0).p_W.x() +
                                       kGravity * chain.island().state(0).p_W.z());
    };
    const double start = energyOf(), unit = kMass * load * radius;
    double worst = 0.0;
    for (int tick = 0; tick < 20; ++tick) {
      chain.run(kTick);
      worst = std::max(worst, std::abs(energyOf() - start));
    }
    EXPECT_LT(worst, 1e-5 * unit) << load;
    EXPECT_LT(chain.off, 1e-9) << load;
  }
}

TEST(IslandJoints, KeepTheEnergyOfChains) {
  for (const int count : {2, 5, 20}) {
    Chain chain(count, Vec3::UnitY());
    chain.start();
    chain.run(count == 20 ? 1.0 : 5.0);
    EXPECT_LT(chain.most_energy, 1e-6 * kUnit) << count << " links";
    EXPECT_GT(chain.least_energy, -1e-6 * kUnit) << count << " links";
    EXPECT_LT(chain.off, 1e-9) << count << " links";
  }
}

TEST(IslandJoints, TakeLongTicksAsExactlyAsShortOnes) {
  Chain coarse(5, Vec3::UnitY(), 4e-3), fine(5, Vec3::UnitY(), 2.5e-4);
  coarse.start();
  fine.start();
  coarse.run(1.0);
  fine.run(1.0);
  for (BodyIndex b = 0; b < 5; ++b)
    EXPECT_LT((coarse.island().state(b).p_W - fine.island().state(b).p_W).norm(), 1e-6);
}

// Forces of joints are dear. A step of order 4 asks for them five times, one of order 5 seven
// times.
TEST(IslandJoints, TakeStepsOfOrder4WhereTheyAreExactEnough) {
  Chain slow(3, Vec3::UnitY());
  slow.start();
  slow.run(0.2);
  const IslandCounters& of_slow = slow.island().counters();
  EXPECT_EQ(of_slow.steps_of_order_4, of_slow.integrated_steps);
  EXPECT_EQ(of_slow.rejected_steps, 0u);

  Chain fast(1, Vec3::UnitY());
  fast.start();
  const double speed = 150.0;  // [rad/s]
  RigidState state = fast.island().state(0);
  state.w_W = speed * Vec3::UnitY();
  state.v_W = state.w_W.cross(state.p_W);
  fast.island().setState(0, state);
  fast.run(1.0);
  const IslandCounters& of_fast = fast.island().counters();
  EXPECT_LT(of_fast.steps_of_order_4, of_fast.integrated_steps / 10);
  EXPECT_GT(of_fast.rejected_steps, of_fast.integrated_steps / 20);
  EXPECT_LT(fast.most_energy - fast.least_energy, 1e-7 * fast.energy());
  EXPECT_LT(fast.off, 1e-9);
}

// Without gravity, linear and angular momentum stay whatever the joint.
TEST(IslandJoints, KeepMomentum) {
  constexpr std::uint64_t kSeed = 20261126;
  RecordProperty("seed", std::to_string(kSeed));
  test::Random random(kSeed);
  for (int run = 0; run < 20; ++run) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + " run " + std::to_string(run));
    Island island{IslandSettings{}};
    PlainJoints joints;
    for (int i = 0; i < 3; ++i) {
      IslandBody link = makeLink({kLength * i, 0.0, 0.0});
      link.start.v_W = random.inCube(0.5);
      link.start.w_W = random.inCube(3.0);
      island.addBody(link);
      if (i == 0) continue;
      PlainJoints::Joint joint;
      joint.at_A = Vec3(-0.5 * kLength, 0.0, 0.0);
      joint.at_B = Vec3(0.5 * kLength, 0.0, 0.0);
      if (random.below(2) == 0) joint.axis_A = joint.axis_B = Vec3(random.inCube(1.0).normalized());
      joints.add(i, i - 1, joint);
    }
    island.setJointSource(&joints);
    island.prepare();
    const auto momentum = [&](Vec3& linear, Vec3& angular) {
      linear = angular = Vec3::Zero();
      for (BodyIndex b = 0; b < 3; ++b) {
        const RigidState& s = island.state(b);
        const Vec3 w_B = s.q_WB.conjugate() * s.w_W;
        linear += kMass * s.v_W;
        angular +=
            kMass * s.p_W.cross(s.v_W) + s.q_WB * Vec3(island.body(b).inertia_B.cwiseProduct(w_B));
      }
    };
    Vec3 linear, angular, linear_after, angular_after;
    momentum(linear, angular);
    for (int i = 0; i < 1000; ++i) island.advance(kTick);
    momentum(linear_after, angular_after);
    EXPECT_LT((linear_after - linear).norm(), 1e-12);
    EXPECT_LT((angular_after - angular).norm(), 1e-9);
  }
}

TEST(IslandJoints, StopAtALimitAndRestThere) {
  Chain arm(1, -Vec3::UnitY());
  arm.joints.joint(0).least_angle = -0.5;
  arm.start();
  double past = 0.0;
  for (int i = 0; i < 2000; ++i) {
    arm.run(kTick);
    past = std::min(past, arm.angleAbout(-Vec3::UnitY()) + 0.5);
  }
  EXPECT_GT(past, -1e-8);
  EXPECT_NEAR(arm.angleAbout(-Vec3::UnitY()), -0.5, 1e-8);
  EXPECT_LT(arm.island().state(0).w_W.norm(), 1e-9);
  EXPECT_LT(arm.off, 1e-9);
  // It lets go at once.
  arm.push(Vec3(0.0, -1.0, 0.0));
  arm.run(0.1);
  EXPECT_GT(arm.angleAbout(-Vec3::UnitY()), -0.45);
}

// A body that falls on a stop by an angle phi meets it at the speed sqrt(2 dE / I).
TEST(IslandJoints, BounceOffALimit) {
  constexpr double kBounce = 0.5, kStop = -0.5;
  Chain arm(1, -Vec3::UnitY());
  arm.joints.joint(0).least_angle = kStop;
  arm.joints.joint(0).bounce = kBounce;
  arm.start();
  bool has_met = false;
  double highest = kStop;
  for (int i = 0; i < 400; ++i) {
    arm.run(kTick);
    const bool rises = arm.island().state(0).w_W.dot(-Vec3::UnitY()) > 0.0;
    if (has_met && !rises && highest > kStop + 1e-3) break;
    has_met |= rises;
    if (has_met) highest = std::max(highest, arm.angleAbout(-Vec3::UnitY()));
  }
  // Heights of the arm's middle.
  EXPECT_NEAR(std::sin(highest) - std::sin(kStop), -kBounce * kBounce * std::sin(kStop), 1e-5);
}

TEST(IslandJoints, MotorsPushWithinTheirForce) {
  constexpr double kSpeed = 0.7, kTorque = 0.02;
  Chain arm(1, Vec3::UnitZ());
  arm.joints.joint(0).motor = {kSpeed, kTorque};
  arm.start();
  const double inertia = arm.island().body(0).inertia_B.z() + 0.25 * kMass * kLength * kLength;
  const double until = kSpeed * inertia / kTorque;  // it is at speed
  arm.run(0.1);
  EXPECT_NEAR(arm.angleAbout(Vec3::UnitZ()), 0.5 * kTorque / inertia * 0.01, 1e-8);
  arm.run(0.9);
  EXPECT_NEAR(arm.island().state(0).w_W.z(), kSpeed, 1e-12);
  const double angle = kSpeed * (1.0 - 0.5 * until);
  EXPECT_NEAR(arm.angleAbout(Vec3::UnitZ()), angle, 1e-6);
  // A greater torque drives it back against the motor's.
  arm.push(Vec3(0.0, 0.0, -0.03));
  arm.run(0.2);
  EXPECT_NEAR(arm.island().state(0).w_W.z(), kSpeed - 0.01 / inertia * 0.2, 1e-9);
}

// Two boxes on a floor, joined by a ball at their facing edges, pushed into the floor and along it.
TEST(IslandJoints, ShareTheirLoadWithContact) {
  test::BoxScene scene;
  PlainJoints joints;
  const Vec3 half = Vec3::Constant(0.02);
  scene.add(half, 0.2, {0.0, 0.0, 0.02});
  scene.add(half, 0.2, {0.05, 0.0, 0.02});
  PlainJoints::Joint joint;
  joint.at_A = Vec3(-0.025, 0.0, 0.0);
  joint.at_B = Vec3(0.025, 0.0, 0.0);
  joints.add(1, 0, joint);
  scene.island.setJointSource(&joints);
  scene.prepare();
  scene.run(0.5);
  EXPECT_NEAR(scene.island.state(0).p_W.z(), 0.02, 1e-8);
  EXPECT_NEAR(scene.island.state(1).p_W.z(), 0.02, 1e-8);
  // Pulled at one end with 1.5 times what friction holds: both slide at half of g mu.
  const double limit = scene.world.friction * 0.4 * test::BoxScene::kGravity;
  scene.forces[1] = Vec3(1.5 * limit, 0.0, 0.0);
  scene.run(0.2);
  const double speed = 0.5 * limit / 0.4 * 0.2;
  EXPECT_NEAR(scene.island.state(0).v_W.x(), speed, 1e-6);
  EXPECT_NEAR(scene.island.state(1).v_W.x(), speed, 1e-6);
  const RigidState &a = scene.island.state(1), &b = scene.island.state(0);
  EXPECT_LT((a.p_W + a.q_WB * joint.at_A - b.p_W - b.q_WB * joint.at_B).norm(), 1e-9);
}

// Bodies of a planar game: some rows can move nothing but by rounding.
TEST(IslandJoints, HoldBodiesThatKeepTheirPlane) {
  constexpr std::uint64_t kSeed = 20261127;
  RecordProperty("seed", std::to_string(kSeed));
  test::Random random(kSeed);
  for (int run = 0; run < 50; ++run) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + " run " + std::to_string(run));
    Island island{IslandSettings{}};
    PlainJoints joints;
    for (int i = 0; i < 3; ++i) {
      IslandBody link = makeLink({kLength * i, 0.0, 0.0});
      link.linear_factor = Vec3(1.0, 0.0, 1.0);
      link.angular_factor = Vec3(0.0, 1.0, 0.0);
      link.start.q_WB = random.rotation();
      island.addBody(link);
      if (i == 0) continue;
      PlainJoints::Joint joint;
      const Vec3 middle(kLength * (i - 0.5), 0.0, 0.0);
      const auto toBody = [&](BodyIndex b) {
        const RigidState& start = island.body(b).start;
        return Vec3(start.q_WB.conjugate() * (middle - start.p_W));
      };
      joint.at_A = toBody(i);
      joint.at_B = toBody(i - 1);
      if (random.below(2) == 0) {
        joint.axis_A = island.body(i).start.q_WB.conjugate() * Vec3::UnitY();
        joint.axis_B = island.body(i - 1).start.q_WB.conjugate() * Vec3::UnitY();
      }
      joints.add(i, i - 1, joint);
    }
    island.setJointSource(&joints);
    island.prepare();
    island.setExternalWrench(0, Vec3(0.3, 0.2, -1.0), Vec3(0.0, 0.01, 0.0));
    for (int i = 0; i < 500; ++i) island.advance(kTick);
    for (BodyIndex b = 0; b < 3; ++b) {
      ASSERT_TRUE(island.state(b).p_W.allFinite());
      EXPECT_EQ(island.state(b).p_W.y(), 0.0);
      EXPECT_LT(island.state(b).v_W.norm(), 5.0);
    }
    const RigidState &a = island.state(1), &b = island.state(0);
    const PlainJoints::Joint& joint = joints.joint(0);
    EXPECT_LT((a.p_W + a.q_WB * joint.at_A - b.p_W - b.q_WB * joint.at_B).norm(), 1e-9);
  }
}

// Damped, a chain comes to rest as one, and costs nothing until it is pushed.
TEST(IslandJoints, LetAChainRest) {
  test::BoxScene scene;
  scene.world.has_floor = false;
  PlainJoints joints;
  for (int i = 0; i < 2; ++i) {
    scene.add(Vec3(0.02, 0.02, 0.05), 0.2, {0.0, 0.0, -0.05 - 0.1 * i});
    PlainJoints::Joint joint;
    joint.at_A = Vec3(0.0, 0.0, 0.05);
    joint.at_B = i == 0 ? Vec3(Vec3::Zero()) : Vec3(0.0, 0.0, -0.05);
    joints.add(i, i - 1, joint);
  }
  scene.island.setJointSource(&joints);
  scene.prepare();
  for (BodyIndex b = 0; b < 2; ++b)
    scene.island.setExternalWrench(b, Vec3(0.0, 0.0, -0.2 * test::BoxScene::kGravity),
                                   Vec3::Zero());
  for (int i = 0; i < 200; ++i) scene.island.advance(kTick);
  EXPECT_TRUE(scene.island.isAsleep());
  scene.island.applyImpulse(1, Vec3(0.02, 0.0, 0.0), Vec3::Zero());
  for (int i = 0; i < 100; ++i) scene.island.advance(kTick);
  EXPECT_FALSE(scene.island.isAsleep());
  EXPECT_GT(scene.island.state(1).p_W.x(), 1e-3);
  EXPECT_NE(scene.island.state(0).p_W.x(), 0.0);
}

// The edge of a lid on a hinge hits the floor.
TEST(IslandJoints, LetALidFallOnTheFloor) {
  test::BoxScene scene;
  PlainJoints joints;
  scene.add(Vec3(0.1, 0.1, 0.005), 0.3, {0.1, 0.0, 0.055});

  PlainJoints::Joint hinge;
  hinge.at_A = Vec3(-0.1, 0.0, 0.0);
  hinge.at_B = Vec3(0.0, 0.0, 0.055);
  hinge.axis_A = hinge.axis_B = Vec3::UnitY();
  joints.add(0, kStanding, hinge);
  scene.island.setJointSource(&joints);
  scene.prepare();
  scene.run(1.0);
  // The lid's far edge rests on the floor, and its pin has not moved.
  const RigidState& lid = scene.island.state(0);
  EXPECT_LT((lid.p_W + lid.q_WB * hinge.at_A - hinge.at_B).norm(), 1e-9);
  EXPECT_LT(lid.v_W.norm(), 1e-8);
  EXPECT_NEAR((lid.p_W + lid.q_WB * Vec3(0.1, 0.1, -0.005)).z(), 0.0, 1e-8);
}

}  // namespace
}  // namespace tandem
