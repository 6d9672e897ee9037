// The local hand's grip of one body in a host at 60 Hz.

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "tandem/falcon/simulated_device.h"

#include "grip/grip_rig.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::glide;
using test::GripHost;
using test::kHostStep;
using test::kTick;
using test::reasonOf;
using test::ScriptedDevice;

constexpr double kTop = 0.05;     // height of a hand that touches the body from above [m]
constexpr double kLifted = 0.1;   // height of the hand's way [m]
constexpr double kWeight = 9.81;  // [N/kg]

/// A hand that holds the handle at the origin.
class SpringHand final : public Hand {
 public:
  Vec3 computeForce(double, const PointState& handle) const noexcept override {
    return -200.0 * handle.p_W - 1.0 * handle.v_W;
  }
};

/// A hand that lifts from the body's top between two times.
ScriptedDevice::Path lift(double from, double to) {
  return [=](double t) { return Vec3(0, 0, kTop + kLifted * glide(t, from, to)); };
}

class LiftedMass : public testing::TestWithParam<double> {};

TEST_P(LiftedMass, HangsAtTheHandWithoutCreep) {
  const double mass = GetParam();
  GripHost host(lift(0.5, 1.0));
  host.start(mass);
  host.run(0.2);
  const double from_hand = host.object().z() - host.hand().z();
  host.site->grab(0);
  double gap = 0.0, sag = 0.0, low = 1.0, high = 0.0;
  const auto findGap = [&] { return host.object().z() - host.hand().z() - from_hand; };
  host.run(1.3, [&] { gap = std::max(gap, std::abs(findGap())); });
  host.run(1.5);
  host.run(5.0, [&] {
    sag = std::max(sag, std::abs(findGap()));
    low = std::min(low, host.at().z());
    high = std::max(high, host.at().z());
  });
  std::printf("%.2f kg: gap while lifted %.2f mm, sag %.5f mm, creep in 5 s %.6f mm\n", mass,
              1e3 * gap, 1e3 * sag, 1e3 * (high - low));
  EXPECT_LT(sag, 5e-5);
  EXPECT_LT(high - low, 5e-5);
  EXPECT_NEAR(host.at().z(), 0.02 + kLifted, 2e-4);
  EXPECT_NEAR(host.site->force().z(), -kWeight * mass, 1e-3 * kWeight * mass);
  EXPECT_TRUE(host.site->grip());
}
INSTANTIATE_TEST_SUITE_P(Masses, LiftedMass, testing::Values(0.02, 0.1, 1.0, 2.0));

TEST(LocalGrip, WithoutLiftTheBodySags) {
  GripHost host(lift(0.5, 1.0));
  host.settings.grip.lift_time = 0.0;
  host.start(1.0);
  host.run(0.2);
  host.site->grab(0);
  host.run(3.0);
  EXPECT_NEAR(host.at().z(), 0.02 + kLifted - kWeight / 2000.0, 3e-4);
}

// Over each tick the body's momentum changes by minus the impulse at the hand: the mean of the
// forces at both ends, to the square of a tick.
TEST(LocalGrip, ReactionIsMinusActionInEachTick) {
  for (const double mass : {0.02, 0.2, 1.0, 5.0}) {
    GripHost host(
        [](double t) { return Vec3(0.03 * std::sin(9.0 * t), 0.02 * std::sin(13.0 * t), 1.0); });
    host.rig.world.setGravity(btVector3(0, 0, 0));
    host.settings.tick_source = TickSource::kCaller;
    host.settings.grip.max_force = 1e3;
    host.start(mass, Vec3::Constant(0.02), 1.0);
    host.site->grab(0, Vec3::Zero());
    double strongest = 0.0, worst = 0.0;
    for (int tick = 0; tick < 2000; ++tick) {
      const Vec3 v_W = host.site->object(0).v_W;
      host.site->tick(tick * kTick);
      const Vec3 on_hand_W = host.site->force(), on_body_W = host.site->grip()->force_W;
      if (tick < 100) continue;
      strongest = std::max(strongest, on_hand_W.norm());
      const Vec3 gained_W = mass / kTick * (host.site->object(0).v_W - v_W);
      worst = std::max(worst, (gained_W - 0.5 * (on_body_W - on_hand_W)).norm());
    }
    std::printf("%.2f kg: up to %.3f N, action and reaction differ by %.5f N\n", mass, strongest,
                worst);
    EXPECT_GT(strongest, 1.0 * mass);
    EXPECT_LT(worst, 2e-3 + 1e-3 * strongest);
  }
}

// A device of 0.1 kg with a damper of 0.5 N s/m alone: a body in it comes to rest, whatever its
// mass.
TEST(LocalGrip, IsStableWithADevice) {
  for (const double mass : {0.02, 0.1, 1.0, 5.0}) {
    BulletRig rig;
    btRigidBody& body = rig.addCube(mass, 0.02, Vec3(0.005, 0.002, 0.0));
    SimulatedDeviceSettings handle;
    handle.mass = 0.1;
    handle.damping = 0.5;
    SimulatedDevice device(handle, std::make_unique<SpringHand>());
    SiteSettings settings;
    settings.peers = 1;
    settings.tick_source = TickSource::kCaller;
    Site site(settings, rig.world, device);
    site.share(body);
    site.grab(0);
    double early = 0.0, late = 0.0;
    for (int tick = 0; tick < 20000; ++tick) {
      if (tick == 1000) body.applyCentralImpulse(btVector3(static_cast<btScalar>(0.02), 0, 0));
      site.tick(tick * kTick);
      if (tick % 4 == 3) rig.step(4.0 * kTick);
      double& most = tick < 10000 ? early : late;
      most = std::max(most, (site.object(0).v_W - site.hip().v_W).norm());
    }
    std::printf("%.2f kg: body beside hand at most %.4f m/s, after 10 s %.2e m/s\n", mass, early,
                late);
    EXPECT_LT(late, 1e-4);
  }
}

// A hand that runs away from a body that cannot follow.
TEST(LocalGrip, BreaksWhenPulledTooHard) {
  GripHost host([](double t) { return Vec3(0, 0, kTop + 0.6 * std::max(0.0, t - 0.5)); });
  host.rig.world.setGravity(btVector3(0, 0, 0));
  host.start(50.0);
  host.run(0.3);
  host.site->grab(0);
  double most = 0.0, broken_at = 0.0, limited_at = 0.0;
  host.run(1.5, [&] {
    const double force = host.site->force().norm();
    most = std::max(most, force);
    if (force > 39.99 && limited_at == 0.0) limited_at = host.now;
    if (host.site->counters().grips_broken == 1 && broken_at == 0.0) broken_at = host.now;
  });
  EXPECT_NEAR(most, 40.0, 1e-9);
  EXPECT_EQ(host.site->counters().grips_broken, 1u);
  EXPECT_NEAR(broken_at - limited_at, 0.1, 2.1 * kHostStep);
  EXPECT_FALSE(host.site->grip());
  EXPECT_EQ(host.site->force(), Vec3::Zero());
}

// Pulled at the limit for less than `break_time` it holds.
TEST(LocalGrip, HoldsAShortTug) {
  GripHost host([](double t) {
    return Vec3(0, 0, kTop + 0.03 * (glide(t, 0.5, 0.55) - glide(t, 0.58, 0.63)));
  });
  host.rig.world.setGravity(btVector3(0, 0, 0));
  host.start(50.0);
  host.run(0.3);
  host.site->grab(0);
  double most = 0.0;
  host.run(1.0, [&] { most = std::max(most, host.site->force().norm()); });
  EXPECT_GT(most, 39.0);
  EXPECT_EQ(host.site->counters().grips_broken, 0u);
  EXPECT_TRUE(host.site->grip());
}

// After a release the force fades within 50 ms, and the body falls from rest.
TEST(LocalGrip, ReleaseFadesWithoutAJump) {
  GripHost host(lift(0.5, 1.0));
  host.settings.tick_source = TickSource::kCaller;
  host.start(1.0);
  double force = 0.0, speed = 0.0, jump = 0.0, kick = 0.0, faded_after = 0.0;
  for (int tick = 0; tick < 2600; ++tick) {
    if (tick == 200) host.site->grab(0);
    if (tick == 2500) host.site->release();
    host.site->tick(tick * kTick);
    if (tick % 4 == 3) host.rig.step(4.0 * kTick);
    const double force_now = host.site->force().z(), speed_now = host.site->object(0).v_W.z();
    if (tick >= 2500) {
      jump = std::max(jump, std::abs(force_now - force));
      kick = std::max(kick, speed_now - speed);
      if (host.site->grip()) faded_after = (tick - 2499) * kTick;
      EXPECT_EQ(host.site->grip().has_value(), force_now != 0.0);
    }
    force = force_now;
    speed = speed_now;
  }
  EXPECT_NEAR(faded_after, 0.05, 1.5 * kTick);
  EXPECT_LT(jump, 0.5);
  EXPECT_LE(kick, 1e-9);  // it only falls
  EXPECT_LT(host.object().z(), 0.02 + kLifted - 0.02);
}

// The account of energy lets a hand lower what it has lifted, and feel its weight all the way.
TEST(LocalGrip, LowersWhatItLifted) {
  for (const double height : {0.1, 0.2}) {
    GripHost host([=](double t) {
      return Vec3(0, 0, kTop + height * (glide(t, 0.5, 1.5) - glide(t, 3.0, 4.0)));
    });
    host.settings.passivity = {};
    host.start(1.0);
    host.run(0.2);
    host.site->grab(0);
    host.run(2.8);
    EXPECT_NEAR(host.site->force().z(), -kWeight, 0.1);
    double lightest = HUGE_VAL;
    host.run(1.0, [&] { lightest = std::min(lightest, -host.site->force().z()); });
    std::printf("lowered by %.1f m: at least %.2f N, %d ticks limited\n", height, lightest,
                static_cast<int>(host.site->counters().energy_limited));
    EXPECT_GT(lightest, 0.5 * kWeight);
    EXPECT_NEAR(host.at().z(), 0.02, 1e-3);
  }
}

// A place far from the hand: the body comes to it, no faster than half a metre per second.
TEST(LocalGrip, TheBodyComesToTheHand) {
  GripHost host([](double) { return Vec3(0, 0, 0.3); });
  host.rig.world.setGravity(btVector3(0, 0, 0));
  host.start(0.5);
  host.run(0.1);
  host.site->grab(0, Vec3(0.01, 0, 0));
  double fastest = 0.0, strongest = 0.0;
  host.run(1.5, [&] {
    fastest = std::max(fastest, host.site->object(0).v_W.norm());
    strongest = std::max(strongest, host.site->force().norm());
  });
  EXPECT_LT(fastest, 1.0);
  EXPECT_LT(strongest, 10.0);
  EXPECT_LT((host.object() - Vec3(-0.01, 0, 0.3)).norm(), 1e-5);
}

TEST(LocalGrip, IsRefusedWithTheReason) {
  GripHost host(lift(9.0, 10.0));
  host.start(0.2);
  btRigidBody& other = host.rig.addCube(0.2, 0.02, Vec3(0.2, 0, 0.02));
  host.site->share(other);
  host.run(0.1);
  EXPECT_EQ(reasonOf([&] { host.site->grab(2); }), "there is no object 2; this site has 2");
  EXPECT_EQ(reasonOf([&] { host.site->grab(0, Vec3(0, 0, NAN)); }),
            "the place of a grip must be finite and within 1000 m");
  host.site->grab(0);
  EXPECT_EQ(reasonOf([&] { host.site->grab(1); }), "the hand holds object 0; release it first");
  EXPECT_EQ(reasonOf([&] { host.site->grab(0); }), "");  // anew
  host.site->release();
  host.site->unshare(0);
  EXPECT_EQ(reasonOf([&] { host.site->grab(0); }),
            "object 0 is not shared any more; share a body for it");
  other.setCollisionFlags(other.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  host.run(0.1);
  EXPECT_EQ(reasonOf([&] { host.site->grab(1); }),
            "object 1 is left to Bullet, so no hand can hold it; Site::warnings() says why");
}

TEST(LocalGrip, IsRefusedWithAGuide) {
  GripHost host([](double) { return Vec3(0, 0, kTop); });
  host.settings.guide = Vec3::UnitX();
  host.start(0.2);
  EXPECT_EQ(reasonOf([&] { host.site->grab(0); }),
            "a hand holds objects only with the island and hand-off, and without a guide; leave "
            "guide, contact_model and injection at their defaults");
}

/// Ends of an object in the hand, other than a release.
enum class End { kUnshared, kTakenOut, kPutElsewhere };

class EndOfGrip : public testing::TestWithParam<End> {};

TEST_P(EndOfGrip, LetsTheHandGo) {
  GripHost host(lift(0.5, 1.0));
  host.start(0.5);
  host.run(0.2);
  host.site->grab(0);
  host.run(1.5);
  EXPECT_LT(host.site->force().z(), -4.0);
  switch (GetParam()) {
    case End::kUnshared:
      host.site->unshare(0);
      break;
    case End::kTakenOut:
      host.rig.world.removeRigidBody(host.body);
      break;
    case End::kPutElsewhere:
      host.body->setWorldTransform(toBullet(Vec3(0.5, 0, 0.5), Quat::Identity()));
      host.body->setInterpolationWorldTransform(host.body->getWorldTransform());
      break;
  }
  host.run(0.2);
  EXPECT_FALSE(host.site->grip());
  EXPECT_EQ(host.site->force(), Vec3::Zero());
  EXPECT_EQ(host.site->status() & ~kBodyMissing, kTickOk);
  EXPECT_LT(fromBullet(host.body->getLinearVelocity()).norm(), 2.5);
  host.site->release();
  if (GetParam() != End::kTakenOut) return;
  host.rig.world.addRigidBody(host.body);
  host.run(0.1);
  host.site->grab(0, Vec3::Zero());
  host.run(0.5);
  EXPECT_TRUE(host.site->grip());
}
INSTANTIATE_TEST_SUITE_P(All, EndOfGrip,
                         testing::Values(End::kUnshared, End::kTakenOut, End::kPutElsewhere));

// A body that is pushed onto the floor makes the hand feel the floor, and its weight is not lifted.
TEST(LocalGrip, FeelsWhatTheBodyTouches) {
  GripHost host([](double t) { return Vec3(0, 0, kTop - 0.004 * glide(t, 0.5, 1.0)); });
  host.start(0.5);
  host.run(0.2);
  host.site->grab(0);
  host.run(4.0);
  EXPECT_NEAR(host.site->force().z(), 2000.0 * 0.004, 0.1);
  EXPECT_NEAR(host.at().z(), 0.02, 2e-4);
  EXPECT_EQ(host.site->counters().grips_broken, 0u);
}

}  // namespace
}  // namespace tandem
