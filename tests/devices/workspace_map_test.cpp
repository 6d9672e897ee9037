#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "tandem/falcon/mapped_device.h"

#include "devices/told_device.h"
#include "support/random.h"

namespace tandem {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

WorkspaceSettings drawSettings(test::Random& random) {
  WorkspaceSettings settings;
  settings.q_WD = random.rotation();
  settings.centre_D = random.inCube(0.2);
  settings.centre_W = random.inCube(5.0);
  settings.scale = random.logUniform(0.05, 50.0);
  settings.force_scale = random.logUniform(0.05, 20.0);
  return settings;
}

TEST(WorkspaceMap, IsNothingByItself) {
  const WorkspaceMap map;
  const PointState hip{Vec3(1, 2, 3), Vec3(4, 5, 6)};
  EXPECT_EQ(map.toWorld(hip).p_W, hip.p_W);
  EXPECT_EQ(map.toWorld(hip).v_W, hip.v_W);
  EXPECT_EQ(map.toDevice(Vec3(7, 8, 9)), Vec3(7, 8, 9));
}

// A Falcon's z, towards the user, becomes the world's y.
TEST(WorkspaceMap, TurnsScalesAndShifts) {
  WorkspaceSettings settings;
  settings.q_WD = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitY());
  settings.centre_D = Vec3(0, 0, 0.125);
  settings.centre_W = Vec3(1, 2, 3);
  settings.scale = 5.0;
  const WorkspaceMap map(settings);
  const PointState hip = map.toWorld({Vec3(0, 0, 0.135), Vec3(0, 0, 0.1)});
  EXPECT_LT((hip.p_W - Vec3(1, 2.05, 3)).norm(), 1e-15);
  EXPECT_LT((hip.v_W - Vec3(0, 0.5, 0)).norm(), 1e-15);
  EXPECT_LT((map.toDevice(Vec3(0, -3, 0)) - Vec3(0, 0, -3)).norm(), 1e-15);
}

TEST(WorkspaceMap, KeepsTheShareOfWorkAndFeelsSpringsAsItSays) {
  constexpr std::uint64_t kSeed = 21;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int i = 0; i < 1000; ++i) {
    const WorkspaceSettings settings = drawSettings(random);
    const WorkspaceMap map(settings);
    const PointState hip_D{random.inCube(0.1), random.inCube(0.5)};
    const Vec3 f_W = random.inCube(10.0);
    const double at_hand = map.toDevice(f_W).dot(hip_D.v_W);
    const double in_world = f_W.dot(map.toWorld(hip_D).v_W);
    const double ratio = settings.force_scale / settings.scale;
    EXPECT_NEAR(at_hand, ratio * in_world, 1e-12 * (std::abs(at_hand) + f_W.norm()));

    constexpr double kStiffness = 300.0;  // stiffness of a spring in the world [N/m]
    const PointState pulled{hip_D.p_W + random.inCube(0.01), Vec3::Zero()};
    const Vec3 way_W = map.toWorld(pulled).p_W - map.toWorld(hip_D).p_W;
    const Vec3 force_D = map.toDevice(-kStiffness * way_W);
    const double felt = kStiffness * settings.scale * settings.force_scale;
    EXPECT_LT((force_D + felt * (pulled.p_W - hip_D.p_W)).norm(), 1e-10 * felt);
  }
}

TEST(WorkspaceMap, SeesTheDeviceFromTheWorld) {
  DeviceCapabilities device;
  device.name = "told";
  device.max_force = 8.0;
  device.max_slew = 2000.0;
  device.max_stiffness = 1500.0;
  device.workspace = Vec3(0.05, 0.05, 0.03);
  WorkspaceSettings settings;
  settings.q_WD = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitY());
  settings.scale = 4.0;
  settings.force_scale = 0.5;
  const DeviceCapabilities seen = WorkspaceMap(settings).toWorld(device);
  EXPECT_EQ(seen.name, "told");
  EXPECT_DOUBLE_EQ(seen.max_force, 16.0);
  EXPECT_DOUBLE_EQ(seen.max_slew, 4000.0);
  EXPECT_DOUBLE_EQ(seen.max_stiffness, 750.0);
  EXPECT_LT((seen.workspace - Vec3(0.2, 0.12, 0.2)).norm(), 1e-12);
  const DeviceCapabilities endless = WorkspaceMap(settings).toWorld(DeviceCapabilities());
  EXPECT_EQ(endless.max_force, kInf);
  EXPECT_EQ(endless.workspace, Vec3::Constant(kInf));
}

TEST(WorkspaceMap, RefusesWhatIsNoMap) {
  const auto refuses = [](auto change) {
    WorkspaceSettings settings;
    change(settings);
    EXPECT_THROW(WorkspaceMap{settings}, std::invalid_argument);
  };
  refuses([](auto& s) { s.q_WD.coeffs() *= 1.1; });
  refuses([](auto& s) { s.q_WD.x() = std::nan(""); });
  refuses([](auto& s) { s.centre_D.x() = kInf; });
  refuses([](auto& s) { s.centre_W.z() = std::nan(""); });
  for (const double scale : {0.0, -1.0, kInf, std::nan("")}) {
    refuses([&](auto& s) { s.scale = scale; });
    refuses([&](auto& s) { s.force_scale = scale; });
  }
  EXPECT_THROW(MappedDevice(nullptr, {}), std::invalid_argument);
}

TEST(MappedDevice, StandsWithoutForceWhileTheClutchIsOutAndGoesOnFromThere) {
  test::DeviceScript script;
  WorkspaceSettings settings;
  settings.scale = 2.0;
  MappedDevice device(std::make_unique<test::ToldDevice>(script), settings);
  const auto readAt = [&](double x) {
    script.sample.hip = {Vec3(x, 0, 0), Vec3(0.5, 0, 0)};
    return device.read(0.0).hip;
  };
  EXPECT_DOUBLE_EQ(readAt(0.01).p_W.x(), 0.02);
  EXPECT_DOUBLE_EQ(device.read(0.0).hip.v_W.x(), 1.0);
  device.write(Vec3(3, 0, 0));
  EXPECT_EQ(script.force, Vec3(3, 0, 0));

  device.setEngaged(false);
  for (const double x : {0.01, 0.0, -0.03}) {
    EXPECT_DOUBLE_EQ(readAt(x).p_W.x(), 0.02);
    EXPECT_EQ(device.read(0.0).hip.v_W, Vec3::Zero());
    EXPECT_TRUE(device.read(0.0).valid);
    EXPECT_FALSE(device.isEngaged());
    device.write(Vec3(3, 0, 0));
    EXPECT_EQ(script.force, Vec3::Zero());
  }

  device.setEngaged(true);
  EXPECT_FALSE(device.isEngaged());  // takes effect at the next read, so a tick has one answer
  EXPECT_DOUBLE_EQ(readAt(-0.03).p_W.x(), 0.02);
  EXPECT_TRUE(device.isEngaged());
  EXPECT_DOUBLE_EQ(readAt(-0.02).p_W.x(), 0.04);
  EXPECT_EQ(device.map().settings().centre_W, Vec3(0.02, 0, 0));
}

TEST(MappedDevice, IsNotValidWhereTheDeviceIsNotAndPlacesNothingThen) {
  test::DeviceScript script;
  MappedDevice device(std::make_unique<test::ToldDevice>(script), {});
  script.sample = {{Vec3(1, 0, 0), Vec3::Zero()}, false};
  EXPECT_FALSE(device.read(0.0).valid);
  EXPECT_EQ(device.read(0.0).hip.p_W, Vec3::Zero());
  script.sample = {{Vec3(std::nan(""), 0, 0), Vec3::Zero()}, true};
  EXPECT_FALSE(device.read(0.0).valid);

  // The clutch was out before there was a position: the map gives the first one.
  device.setEngaged(false);
  script.sample = {{Vec3(2, 0, 0), Vec3(1, 0, 0)}, true};
  EXPECT_EQ(device.read(0.0).hip.p_W, Vec3(2, 0, 0));
  script.sample.hip.p_W = Vec3(5, 0, 0);
  EXPECT_EQ(device.read(0.0).hip.p_W, Vec3(2, 0, 0));
  device.setEngaged(true);
  script.sample.valid = false;
  EXPECT_FALSE(device.read(0.0).valid);
  EXPECT_FALSE(device.isEngaged());
  script.sample.valid = true;
  EXPECT_EQ(device.read(0.0).hip.p_W, Vec3(2, 0, 0));
}

TEST(MappedDevice, GoesOnFromWhereItsPointIsPut) {
  test::DeviceScript script;
  script.sample.hip.p_W = Vec3(0.02, 0, 0);
  MappedDevice device(std::make_unique<test::ToldDevice>(script), {});
  EXPECT_EQ(device.read(0.0).hip.p_W, Vec3(0.02, 0, 0));
  EXPECT_FALSE(device.putPoint(Vec3(1, 2, 3)));  // the hand has the point
  EXPECT_EQ(device.read(0.0).hip.p_W, Vec3(0.02, 0, 0));

  device.setEngaged(false);
  (void)device.read(0.0);
  EXPECT_TRUE(device.putPoint(Vec3(1, 2, 3)));
  script.sample.hip.p_W = Vec3(0.03, 0, 0);
  EXPECT_EQ(device.read(0.0).hip.p_W, Vec3(1, 2, 3));
  device.setEngaged(true);
  EXPECT_EQ(device.read(0.0).hip.p_W, Vec3(1, 2, 3));
  script.sample.hip.p_W = Vec3(0.04, 0, 0);
  EXPECT_LT((device.read(0.0).hip.p_W - Vec3(1.01, 2, 3)).norm(), 1e-15);
}

TEST(MappedDevice, HearsOfItsClutchFromAnotherThread) {
  test::DeviceScript script;
  MappedDevice device(std::make_unique<test::ToldDevice>(script), {});
  std::thread other([&] {
    for (int i = 0; i < 1000; ++i) device.setEngaged(i % 2 == 0);
  });
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(device.read(i * 1e-3).hip.p_W, Vec3::Zero());
  other.join();
  (void)device.read(1.0);
  EXPECT_FALSE(device.isEngaged());
}

// For any map and clutch, the point only moves by s R times the hand's own way.
TEST(MappedDevice, NeverJumpsAndItsVelocityIsItsPositions) {
  constexpr std::uint64_t kSeed = 22;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  constexpr double kPeriod = 1e-3;
  for (int run = 0; run < 50; ++run) {
    const WorkspaceSettings settings = drawSettings(random);
    test::DeviceScript script;
    MappedDevice device(std::make_unique<test::ToldDevice>(script), settings);
    Vec3 p_D = random.inCube(0.05), last_W = WorkspaceMap(settings).toWorld({p_D, {}}).p_W;
    for (int i = 0; i < 500; ++i) {
      if (random.below(20) == 0) device.setEngaged(random.below(2) == 0);
      const bool was_engaged = device.isEngaged() && i > 0;
      const Vec3 v_D = i > 0 ? random.inCube(0.3) : Vec3(Vec3::Zero());
      p_D += v_D * kPeriod;
      script.sample = {{p_D, v_D}, random.below(10) != 0};
      const DeviceSample sample = device.read(i * kPeriod);
      if (!sample.valid) {
        ASSERT_EQ(sample.hip.v_W, Vec3::Zero());
        p_D -= v_D * kPeriod;  // the next valid reading makes up for this way
        continue;
      }
      const bool moves = was_engaged && device.isEngaged();
      const Vec3 expected_W = moves ? sample.hip.v_W * kPeriod : Vec3(Vec3::Zero());
      ASSERT_LT((sample.hip.p_W - last_W - expected_W).norm(), 1e-12 * (1.0 + settings.scale));
      if (!device.isEngaged()) {
        ASSERT_EQ(sample.hip.v_W, Vec3::Zero());
      }
      last_W = sample.hip.p_W;
    }
  }
}

TEST(MappedDevice, TurnsTheWristAndItsTorqueAlong) {
  WorkspaceSettings settings;
  settings.q_WD = Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()));
  settings.scale = 4.0;
  settings.force_scale = 2.0;
  test::DeviceScript script;
  script.capabilities.max_torque = 0.1;
  script.sample.wrist = WristState{Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX())), Vec3(2, 0, 0)};
  script.sample.buttons = 5;
  MappedDevice device(std::make_unique<test::ToldDevice>(script), settings);
  const DeviceSample sample = device.read(0.0);
  ASSERT_TRUE(sample.wrist);
  EXPECT_LT((sample.wrist->w_W - Vec3(0, 2, 0)).norm(), 1e-12);
  EXPECT_LT(sample.wrist->q_WH.angularDistance(settings.q_WD * script.sample.wrist->q_WH), 1e-12);
  EXPECT_EQ(sample.buttons, 5u);
  EXPECT_DOUBLE_EQ(device.capabilities().max_torque, 0.2);

  // The hand's work is the world's times g / s, by torques as by forces.
  const Vec3 torque_W(0.01, 0.02, 0.03);
  device.writeTorque(torque_W);
  EXPECT_NEAR(script.torque.dot(script.sample.wrist->w_W), 0.5 * torque_W.dot(sample.wrist->w_W),
              1e-12);
  device.setEngaged(false);
  (void)device.read(1.0);
  device.writeTorque(torque_W);
  EXPECT_EQ(script.torque, Vec3::Zero());
}

}  // namespace
}  // namespace tandem
