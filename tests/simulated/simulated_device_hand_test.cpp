// A simulated device in a hand whose force depends on the state or on time.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "tandem/falcon/simulated_device.h"

#include "simulated/simulated_device_rig.h"

namespace tandem {
namespace {

using test::kPeriod;
using test::readTicks;

/// Largest error over 1 s of a handle released 1 cm from the rest of a hand spring. Closed form: x
/// = d (1 - e^-ct (cos wt + c/w sin wt)), c = total damping / 2 m.
double springError(double device_damping, double hand_damping, double period) {
  constexpr double m = 0.1;     // [kg]
  constexpr double K = 1000.0;  // [N/m]
  constexpr double d = 0.01;    // [m]
  SimulatedDeviceSettings settings;
  settings.mass = m;
  settings.damping = device_damping;
  SimulatedDevice device(settings, makeMinimumJerkHand({{0.0, Vec3(d, 0, 0)}}, K, hand_damping));
  const double c = (device_damping + hand_damping) / (2.0 * m);
  const double w = std::sqrt(K / m - c * c);
  double largest = 0.0;
  for (int i = 0; i * period <= 1.0; ++i) {
    const double t = i * period;
    const double expected =
        d * (1.0 - std::exp(-c * t) * (std::cos(w * t) + c / w * std::sin(w * t)));
    largest = std::max(largest, std::abs(device.read(t).hip.p_W.x() - expected));
  }
  return largest;
}

TEST(SimulatedDevice, StiffHandSpringIsAccurateAtOneKilohertz) {
  // The frequency is off by the fraction (w h)^2 / 24, with w = 100 rad/s and h = 0.25 ms. Over 1 s
  // the phase is off by 2.6e-3 rad: 26 um on 1 cm. Amplitude errors, (w h)^2 / 8, are bounded and
  // add 1 um.
  EXPECT_LT(springError(0.0, 0.0, 1e-3), 28e-6);
  EXPECT_LT(springError(0.5, 0.0, 1e-3), 28e-6);
  EXPECT_LT(springError(0.5, 2.0, 1e-3), 28e-6);
}

TEST(SimulatedDevice, HandSpringDamperConvergesWithSecondOrder) {
  for (const double device_damping : {0.0, 0.5}) {
    for (const double hand_damping : {0.0, 2.0}) {
      // Periods are 1 ms and below, with four sub-steps each. Higher orders are smaller by (w h)^2
      // < 1e-3.
      const double coarse = springError(device_damping, hand_damping, 0x1p-10);
      const double fine = springError(device_damping, hand_damping, 0x1p-11);
      EXPECT_NEAR(coarse / fine, 4.0, 0.1) << device_damping << ", " << hand_damping;
    }
  }
}

TEST(SimulatedDevice, UndampedHandSpringNeitherGainsNorLosesEnergy) {
  constexpr double K = 1000.0;  // [N/m]
  SimulatedDeviceSettings settings;
  settings.damping = 0.0;
  SimulatedDevice device(settings, makeMinimumJerkHand({{0.0, Vec3(0.01, 0, 0)}}, K, 0.0));
  const double start = 0.5 * K * 0.01 * 0.01;
  for (int i = 0; i <= 10000; ++i) {  // 10 s, 159 swings
    const PointState hip = device.read(i * kPeriod).hip;
    const double stretch = 0.01 - hip.p_W.x();
    const double energy = 0.5 * K * stretch * stretch + 0.5 * settings.mass * hip.v_W.squaredNorm();
    // The energy of a symplectic map swings about its mean by the fraction (w h)^2 / 4 = 1.6e-4.
    ASSERT_NEAR(energy / start, 1.0, 1.7e-4) << i;
  }
}

TEST(SimulatedDevice, SpringSurvivesALateRead) {
  // After 200 ms without a read the sub-steps are still 0.25 ms: the answer is the same as at 1
  // kHz.
  const auto makeSpring = [] {
    return SimulatedDevice({}, makeMinimumJerkHand({{0.0, Vec3(0.01, 0, 0)}}, 1000.0, 0.0));
  };
  SimulatedDevice punctual = makeSpring();
  SimulatedDevice late = makeSpring();
  const PointState expected = readTicks(punctual, 200).hip;
  EXPECT_LT((late.read(0.2).hip.p_W - expected.p_W).norm(), 1e-13);
}

TEST(SimulatedDevice, TimeVaryingHandIsSecondOrder) {
  // m x'' = f sin(wt), b = 0: x = f / (m w) (t - sin(wt) / w).
  const double f = 2.0, frequency = 5.0, w = 2.0 * 3.14159265358979323846 * frequency;
  const auto error = [&](int reads_per_second) {
    SimulatedDeviceSettings settings;
    settings.damping = 0.0;
    SimulatedDevice device(settings, makeSineHand(Vec3(f, 0, 0), frequency, 0.0));
    double x = 0.0;
    for (int i = 0; i <= reads_per_second; ++i) {
      x = device.read(static_cast<double>(i) / reads_per_second).hip.p_W.x();
    }
    return std::abs(x - f / (settings.mass * w) * (1.0 - std::sin(w) / w));
  };
  EXPECT_LT(error(1024), 0.64 * std::pow(w / 4096.0, 2) / 24.0 * 1.1);  // f / (m w) = 0.64 m/s
  EXPECT_NEAR(error(1024) / error(2048), 4.0, 0.1);
}

class BrokenHand final : public Hand {
 public:
  Vec3 computeForce(double /*t*/, const PointState& /*handle*/) const noexcept override {
    return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  }
};

TEST(SimulatedDevice, HandThatBreaksItsPromiseMakesReadingsInvalid) {
  for (const double resolution : {0.0, 1e-5}) {
    SimulatedDeviceSettings settings;
    settings.encoder_resolution = resolution;
    SimulatedDevice device(settings, std::make_unique<BrokenHand>());
    EXPECT_TRUE(device.read(0.0).valid);
    EXPECT_FALSE(device.read(kPeriod).valid);
  }
}

}  // namespace
}  // namespace tandem
