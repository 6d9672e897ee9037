#include "tandem/falcon/simulated_device.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "simulated/simulated_device_rig.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::kEps;
using test::kPeriod;
using test::makeDevice;
using test::readTicks;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Scalar closed form of m x'' + b x' = f from rest, b > 0, in extended precision:
///  x = f/b (t - tau (1 - e^-t/tau)), v = f/b (1 - e^-t/tau), tau = m/b.
struct ClosedForm {
  long double x;
  long double v;
};
ClosedForm fromRest(double m, double b, double f, double t) {
  const long double a = static_cast<long double>(b) * t / m;  // t / tau
  const long double risen = -std::expm1(-a);
  long double run =
      a - risen;  // cancels for small a; then the series a^2/2! - a^3/3! + ... is used
  if (a < 0.1L) {
    run = 0.0L;
    long double term = -a;
    for (int n = 2; n < 20; ++n) run += (term *= -a / n);
  }
  const long double terminal = static_cast<long double>(f) / b;
  return {terminal * m / b * run, terminal * risen};
}

// Motion under a constant force.

TEST(SimulatedDevice, FirstReadAtTimeZeroGivesTheStartAtRest) {
  SimulatedDeviceSettings settings;
  settings.start_W = Vec3(0.1, -0.2, 0.3);
  SimulatedDevice device = makeDevice(settings, Vec3(5, 0, 0));
  EXPECT_EQ(device.handle().p_W, settings.start_W);
  const DeviceSample sample = device.read(0.0);
  EXPECT_TRUE(sample.valid);
  EXPECT_EQ(sample.hip.p_W, settings.start_W);
  EXPECT_EQ(sample.hip.v_W, Vec3::Zero());
}

TEST(SimulatedDevice, UndampedHandleFollowsTheParabola) {
  SimulatedDeviceSettings settings;
  settings.mass = 0.25;
  settings.damping = 0.0;
  const Vec3 f(5.0, -1.0, 0.5);
  SimulatedDevice device = makeDevice(settings, f);
  const PointState hip = readTicks(device, 1000).hip;
  const Vec3 a = f / settings.mass;
  // 4000 sub-steps, each rounding x and v once: at most 4000 eps, relative.
  EXPECT_LT((hip.v_W - a).norm(), 4000 * kEps * a.norm());
  EXPECT_LT((hip.p_W - 0.5 * a).norm(), 4000 * kEps * a.norm());
}

// Dampings range from one that changes only the last digits to one that stops the handle within a
// sub-step.
class DampedHandle : public ::testing::TestWithParam<double> {};

TEST_P(DampedHandle, FollowsTheClosedFormToRounding) {
  SimulatedDeviceSettings settings;
  settings.damping = GetParam();
  const double f = 3.0;
  SimulatedDevice device = makeDevice(settings, Vec3(f, 0, 0));
  for (int i = 1; i <= 1000; ++i) {
    const double t = i * kPeriod;
    const PointState hip = device.read(t).hip;
    const ClosedForm expected = fromRest(settings.mass, settings.damping, f, t);
    const double tolerance = (4.0 * i + 16.0) * kEps;  // four roundings a tick
    ASSERT_NEAR(hip.p_W.x() / static_cast<double>(expected.x), 1.0, tolerance) << t;
    ASSERT_NEAR(hip.v_W.x() / static_cast<double>(expected.v), 1.0, tolerance) << t;
  }
}
// b [N s/m]. The series ends where b h / m = 1/2: at b = 200 with m = 0.1 kg and h = 0.25 ms.
INSTANTIATE_TEST_SUITE_P(Damping, DampedHandle,
                         ::testing::Values(1e-4, 0.01, 0.5, 20.0, 190.0, 199.9, 200.0, 200.1, 399.9,
                                           400.1, 2000.0, 1e6, 1e12));

TEST(SimulatedDevice, VanishingDampingMeetsNoDamping) {
  SimulatedDeviceSettings settings;
  settings.damping = 0.0;
  SimulatedDevice free_handle = makeDevice(settings, Vec3(1, 0, 0));
  const PointState free_hip = readTicks(free_handle, 100).hip;
  for (const double damping : {5e-324, 1e-300, 1e-20, 1e-15}) {
    settings.damping = damping;
    SimulatedDevice device = makeDevice(settings, Vec3(1, 0, 0));
    const PointState hip = readTicks(device, 100).hip;
    // Damping takes at most the fraction b t / m = 1e-15; the rest is rounding.
    EXPECT_NEAR(hip.p_W.x(), free_hip.p_W.x(), 400 * kEps * free_hip.p_W.x()) << damping;
    EXPECT_NEAR(hip.v_W.x(), free_hip.v_W.x(), 400 * kEps * free_hip.v_W.x()) << damping;
  }
}

TEST(SimulatedDevice, ReachesTheTerminalVelocity) {
  SimulatedDeviceSettings settings;
  settings.damping = 2.0;
  SimulatedDevice device = makeDevice(settings, Vec3(0, 3, 0));
  // After 2 s = 40 time constants, e^-40 = 4e-18 of the difference is left.
  const PointState hip = readTicks(device, 2000).hip;
  EXPECT_NEAR(hip.v_W.y(), 1.5, 100 * kEps);
}

TEST(SimulatedDevice, StateDoesNotDependOnHowReadsAreGrouped) {
  const std::uint64_t seed = 20090201;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  for (const double damping : {0.0, 0.5, 300.0}) {
    SimulatedDeviceSettings settings;
    settings.damping = damping;
    const Vec3 f = random.inCube(5.0);
    SimulatedDevice once = makeDevice(settings, f);
    SimulatedDevice often = makeDevice(settings, f);
    const PointState expected = once.read(1.0).hip;
    for (double t = 0.0; t < 1.0; t += random.uniform(0.0, 0.02)) (void)often.read(t);
    const PointState hip = often.read(1.0).hip;
    // Both runs take at most 4000 sub-steps, each within one rounding of the exact map.
    EXPECT_LT((hip.p_W - expected.p_W).norm(), 8000 * kEps * expected.p_W.norm()) << damping;
    EXPECT_LT((hip.v_W - expected.v_W).norm(), 8000 * kEps * expected.v_W.norm()) << damping;
  }
}

TEST(SimulatedDevice, SameCallsGiveTheSameBits) {
  SimulatedDeviceSettings settings;
  settings.guide = Vec3(1, 2, 3).normalized();
  settings.encoder_resolution = 1e-5;
  const auto run = [&settings] {
    SimulatedDevice device(settings, makeSineHand(Vec3(1, 2, 3), 3.0, 0.1));
    for (int i = 0; i < 500; ++i) device.write(-100.0 * device.read(i * kPeriod).hip.p_W);
    return device.handle();
  };
  const PointState first = run();
  const PointState second = run();
  EXPECT_EQ(first.p_W, second.p_W);
  EXPECT_EQ(first.v_W, second.v_W);
}

TEST(SimulatedDevice, TimeThatStandsStillOrRunsBackMovesNothing) {
  SimulatedDevice device = makeDevice({}, Vec3(5, 0, 0));
  const PointState before = device.read(0.25).hip;
  for (const double now : {0.25, 0.1, -1.0, kNan, kInfinity, -kInfinity}) {
    const DeviceSample sample = device.read(now);
    EXPECT_TRUE(sample.valid) << now;
    EXPECT_EQ(sample.hip.p_W, before.p_W) << now;
    EXPECT_EQ(sample.hip.v_W, before.v_W) << now;
  }
  // The clock is still at 0.25 s.
  SimulatedDevice other = makeDevice({}, Vec3(5, 0, 0));
  (void)other.read(0.25);
  EXPECT_EQ(device.read(0.5).hip.p_W, other.read(0.5).hip.p_W);
}

// The rendered force.

TEST(SimulatedDevice, HoldsTheWrittenForceUntilTheNextWrite) {
  SimulatedDeviceSettings settings;
  settings.damping = 0.0;
  const double m = settings.mass;
  SimulatedDevice device = makeDevice(settings, Vec3(5, 0, 0));
  device.write(Vec3(-2, 1, 0));
  (void)device.read(0.1);
  (void)device.read(0.2);  // still held
  device.write(Vec3(7, 7, 7));
  device.write(Vec3(-5, 0, 0));  // only the last write counts
  const PointState coasting = device.read(0.3).hip;
  // The handle has 0.2 s under (3, 1, 0) N, then 0.1 s without force: 1200 sub-steps of rounding.
  const Vec3 v = Vec3(3, 1, 0) * 0.2 / m;
  EXPECT_LT((coasting.v_W - v).norm(), 1200 * kEps * v.norm());
  EXPECT_LT((coasting.p_W - v * (0.1 + 0.1)).norm(), 1200 * kEps * v.norm());
}

TEST(SimulatedDevice, ForceWrittenNowDoesNotActOnThePast) {
  SimulatedDevice device = makeDevice({}, Vec3::Zero());
  (void)device.read(0.5);
  device.write(Vec3(100, 0, 0));
  EXPECT_EQ(device.read(0.5).hip.p_W, Vec3::Zero());
  EXPECT_GT(device.read(0.501).hip.p_W.x(), 0.0);
}

TEST(SimulatedDevice, NonFiniteForceIsZero) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 f(1, 1, 1);
      f[axis] = bad;
      SimulatedDevice device = makeDevice({}, Vec3::Zero());
      device.write(Vec3(3, 0, 0));
      device.write(f);  // also removes the earlier force
      const DeviceSample sample = device.read(0.1);
      EXPECT_TRUE(sample.valid);
      EXPECT_EQ(sample.hip.p_W, Vec3::Zero());
      EXPECT_EQ(sample.hip.v_W, Vec3::Zero());
    }
  }
}

/// The force that the motors give for `f`, measured from the velocity of a free 1 kg handle after 1
/// s.
Vec3 measureForce(double max_force, const Vec3& f) {
  SimulatedDeviceSettings settings;
  settings.mass = 1.0;
  settings.damping = 0.0;
  settings.max_force = max_force;
  SimulatedDevice device = makeDevice(settings, Vec3::Zero());
  device.write(f);
  return device.read(1.0).hip.v_W;
}

TEST(SimulatedDevice, ForceSaturatesAndKeepsItsDirection) {
  const double tolerance = 4000 * kEps;
  const Vec3 direction = Vec3(3, -2, 6) / 7.0;
  EXPECT_LT((measureForce(8.0, 7.9 * direction) - 7.9 * direction).norm(), 8 * tolerance);
  for (const double size : {8.1, 100.0, 1e200, 1.7e308}) {
    EXPECT_LT((measureForce(8.0, size * direction) - 8.0 * direction).norm(), 8 * tolerance)
        << size;
  }
  EXPECT_LT((measureForce(1e-3, 1e-2 * direction) - 1e-3 * direction).norm(), 1e-3 * tolerance);
  EXPECT_LT((measureForce(kInfinity, 1e9 * direction) - 1e9 * direction).norm(), 1e9 * tolerance);
  EXPECT_EQ(measureForce(0.0, direction), Vec3::Zero());
  EXPECT_EQ(measureForce(8.0, Vec3::Zero()), Vec3::Zero());
}

TEST(SimulatedDevice, TellsItsCapabilities) {
  SimulatedDeviceSettings settings;
  settings.max_force = 8.0;
  settings.guide = Vec3(0, 1, 0);
  const SimulatedDevice device = makeDevice(settings, Vec3::Zero());
  EXPECT_EQ(device.capabilities().name, "simulated");
  EXPECT_EQ(device.capabilities().degrees_of_freedom, 3);
  EXPECT_EQ(device.capabilities().max_force, 8.0);
}

// The guide.

TEST(SimulatedDevice, GuideKeepsTheMotionOnItsLine) {
  const std::uint64_t seed = 5;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  for (int round = 0; round < 20; ++round) {
    SimulatedDeviceSettings settings;
    const Vec3 axis = random.inCube(1.0).normalized();
    settings.guide = axis;
    settings.start_W = random.inCube(0.5);
    settings.encoder_resolution = round % 2 == 0 ? 0.0 : 1e-4;
    SimulatedDevice device(settings, makeSineHand(random.inCube(5.0), 2.0, 0.4));
    for (int i = 0; i <= 2000; ++i) {
      const PointState hip = device.read(i * kPeriod).hip;
      // One rounding of start + s * guide per component, whatever happened before.
      const Vec3 moved = hip.p_W - settings.start_W;
      const double tolerance = 4.0 * kEps * (settings.start_W.norm() + moved.norm());
      ASSERT_LE(moved.cross(axis).norm(), tolerance) << i;
      ASSERT_LE(hip.v_W.cross(axis).norm(), 4.0 * kEps * hip.v_W.norm()) << i;
      device.write(random.inCube(3.0));
    }
  }
}

TEST(SimulatedDevice, GuideLetsThroughTheForceAlongIt) {
  const std::uint64_t seed = 6;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  for (int round = 0; round < 20; ++round) {
    const Vec3 axis = random.inCube(1.0).normalized();
    const Vec3 hand = random.inCube(5.0);
    const Vec3 rendered = random.inCube(5.0);
    SimulatedDeviceSettings settings;
    settings.guide = axis;
    SimulatedDevice device = makeDevice(settings, hand);
    device.write(rendered);
    const PointState hip = readTicks(device, 100).hip;
    const double f = axis.dot(hand + rendered);
    const ClosedForm along = fromRest(settings.mass, settings.damping, f, 0.1);
    // Rounding of 400 sub-steps. The projection itself may cancel down from 10 N.
    const double tolerance = (400.0 + 40.0 / std::abs(f)) * kEps;
    EXPECT_LT((hip.p_W - static_cast<double>(along.x) * axis).norm(),
              tolerance * std::abs(static_cast<double>(along.x)));
    EXPECT_LT((hip.v_W - static_cast<double>(along.v) * axis).norm(),
              tolerance * std::abs(static_cast<double>(along.v)));
  }
}

TEST(SimulatedDevice, GuideAlongAnAxisLeavesTheOthersUntouched) {
  SimulatedDeviceSettings settings;
  settings.guide = Vec3(1, 0, 0);
  settings.start_W = Vec3(0.1, 0.2, 0.3);
  SimulatedDevice device = makeDevice(settings, Vec3(5, 100, -100));
  const PointState hip = readTicks(device, 1000).hip;
  EXPECT_GT(hip.p_W.x(), 1.0);
  EXPECT_EQ(hip.p_W.tail<2>(), settings.start_W.tail<2>());
  EXPECT_EQ(hip.v_W.tail<2>(), Eigen::Vector2d::Zero());
}

// Settings.

std::string refusal(void (*change)(SimulatedDeviceSettings&)) {
  SimulatedDeviceSettings settings;
  change(settings);
  try {
    (void)makeDevice(settings, Vec3::Zero());
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SimulatedDevice, RefusesBadSettingsByName) {
  struct Case {
    void (*change)(SimulatedDeviceSettings&);
    const char* begins;
  };
  using Settings = SimulatedDeviceSettings;
  const Case cases[] = {
      {[](Settings& s) { s.mass = 0.0; }, "mass of the simulated device is 0,"},
      {[](Settings& s) { s.mass = -0.1; }, "mass of the simulated device is -0.1,"},
      {[](Settings& s) { s.mass = kNan; }, "mass of the simulated device is nan,"},
      {[](Settings& s) { s.mass = kInfinity; }, "mass of the simulated device is inf,"},
      {[](Settings& s) { s.damping = -1e-9; }, "damping of the simulated device is -1e-09,"},
      {[](Settings& s) { s.damping = kNan; }, "damping of the simulated device is nan,"},
      {[](Settings& s) { s.start_W.y() = kNan; },
       "start_W of the simulated device is [0, nan, 0],"},
      {[](Settings& s) { s.guide = Vec3(0, 0, 0); }, "guide of the simulated device is [0, 0, 0],"},
      {[](Settings& s) { s.guide = Vec3(1, 1, 0); }, "guide of the simulated device is [1, 1, 0],"},
      {[](Settings& s) { s.guide = Vec3(kNan, 0, 0); },
       "guide of the simulated device is [nan, 0, 0],"},
      {[](Settings& s) { s.encoder_resolution = -1.0; },
       "encoder_resolution of the simulated device is -1,"},
      {[](Settings& s) { s.encoder_resolution = kInfinity; },
       "encoder_resolution of the simulated device is inf,"},
      {[](Settings& s) { s.max_force = -8.0; }, "max_force of the simulated device is -8,"},
      {[](Settings& s) { s.max_force = kNan; }, "max_force of the simulated device is nan,"},
  };
  for (const Case& c : cases) {
    const std::string text = refusal(c.change);
    EXPECT_EQ(text.rfind(c.begins, 0), 0U) << c.begins << " in: " << text;
    EXPECT_NE(text.find("must be"), std::string::npos) << text;
  }
  EXPECT_THROW(SimulatedDevice({}, nullptr), std::invalid_argument);
  EXPECT_EQ(refusal([](Settings& s) { s.guide = Vec3(0.6, 0.8, 0); }), "accepted");
}

}  // namespace
}  // namespace tandem
