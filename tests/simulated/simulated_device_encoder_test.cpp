#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "tandem/falcon/simulated_device.h"

#include "simulated/simulated_device_rig.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::kEps;
using test::kPeriod;
using test::makeDevice;
using test::readTicks;

TEST(SimulatedDevice, EncoderIsOffByHalfAStepAtMost) {
  const std::uint64_t seed = 7;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  SimulatedDeviceSettings settings;
  settings.start_W = Vec3(0.01234, -0.2, 0.3);
  settings.encoder_resolution = 6e-5;
  SimulatedDevice device(settings, makeSineHand(Vec3(3, 2, -1), 1.5, 0.2));
  for (int i = 0; i <= 2000; ++i) {
    const Vec3 reading = device.read(i * kPeriod).hip.p_W;
    const Vec3 error = reading - device.handle().p_W;
    ASSERT_LE(error.cwiseAbs().maxCoeff(), 0.5 * settings.encoder_resolution + 4 * kEps) << i;
    // The reading is a whole number of steps from the start. The subtraction is off by eps /
    // resolution steps.
    const Vec3 steps = (reading - settings.start_W) / settings.encoder_resolution;
    ASSERT_LE((steps - steps.array().round().matrix()).cwiseAbs().maxCoeff(), 1e-10) << i;
    device.write(random.inCube(1.0));
  }
}

TEST(SimulatedDevice, EncoderVelocityIsTheFirstDifferenceOfReadings) {
  SimulatedDeviceSettings settings;
  settings.encoder_resolution = 1e-4;
  SimulatedDevice device = makeDevice(settings, Vec3(2, -1, 0));
  DeviceSample last = device.read(0.05);
  EXPECT_EQ(last.hip.v_W, Vec3::Zero()) << "the first read has nothing to compare with";
  double last_time = 0.05;
  for (const double now : {0.051, 0.052, 0.06, 0.0600001, 0.2}) {
    const DeviceSample sample = device.read(now);
    const Vec3 expected = (sample.hip.p_W - last.hip.p_W) / (now - last_time);
    EXPECT_LT((sample.hip.v_W - expected).norm(), 8 * kEps / (now - last_time)) << now;
    const DeviceSample again = device.read(now);
    EXPECT_EQ(again.hip.p_W, sample.hip.p_W) << now;
    EXPECT_EQ(again.hip.v_W, sample.hip.v_W) << now;
    last = sample;
    last_time = now;
  }
}

TEST(SimulatedDevice, EncoderStandsStillBelowHalfAStep) {
  SimulatedDeviceSettings settings;
  settings.damping = 0.0;
  settings.encoder_resolution = 1e-3;
  SimulatedDevice device = makeDevice(settings, Vec3(0.1, 0, 0));  // 1 m/s^2
  for (int i = 0; i <= 31; ++i) {                                  // 0.48 mm
    const PointState hip = device.read(i * kPeriod).hip;
    EXPECT_EQ(hip.p_W, Vec3::Zero()) << i;
    EXPECT_EQ(hip.v_W, Vec3::Zero()) << i;
  }
  EXPECT_EQ(device.read(0.032).hip.p_W, Vec3(1e-3, 0, 0));  // 0.512 mm
}

TEST(SimulatedDevice, EncoderDoesNotChangeTheMotion) {
  SimulatedDeviceSettings settings;
  SimulatedDevice exact = makeDevice(settings, Vec3(5, 0, 0));
  settings.encoder_resolution = 1e-3;
  SimulatedDevice coarse = makeDevice(settings, Vec3(5, 0, 0));
  (void)readTicks(exact, 100);
  (void)readTicks(coarse, 100);
  EXPECT_EQ(coarse.handle().p_W, exact.handle().p_W);
  EXPECT_EQ(coarse.handle().v_W, exact.handle().v_W);
}

}  // namespace
}  // namespace tandem
