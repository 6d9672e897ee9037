// `tandem device` and an emulated Falcon in this process, byte by byte over a pseudo terminal.
// Waits are for outcomes; no time is asserted.

#include <chrono>
#include <csignal>
#include <functional>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tandem/falcon/emulated_falcon_port.h"

#include "falcon/src/novint/falcon_emulator.h"
#include "program/background.h"
#include "program/device_runs.h"
#include "program/tandem_program.h"

namespace tandem {
namespace {

using nlohmann::json;
using test::expectRefused;
using test::Outcome;
using test::runTandem;
using test::TempFolder;

/// An emulated Falcon in this process that another process drives.
class DeviceOfAnotherProcess : public ::testing::TestWithParam<int> {
 protected:
  static FalconEmulatorSettings makeHomed() {
    FalconEmulatorSettings settings;
    settings.runs = settings.is_homed = true;
    return settings;
  }

  double readForceUp() {
    double force = 0.0;
    port.visit([&](FalconEmulator& emulator, double) { force = emulator.plant().force().y(); });
    return force;
  }
  void hold(const Vec3& p_D) {
    port.visit([&](FalconEmulator& emulator, double) { emulator.plant().hold(p_D); });
  }
  static bool waitUntil(const std::function<bool()>& holds) {
    using Clock = std::chrono::steady_clock;
    for (const auto end = Clock::now() + std::chrono::seconds(30); Clock::now() < end;
         std::this_thread::sleep_for(std::chrono::milliseconds(2)))
      if (holds()) return true;
    return holds();
  }

  EmulatedFalconPort port{makeHomed()};
};

// From bytes to newtons: the motors push up a grip that is held in the cube. Any end of the program
// removes the force.
TEST_P(DeviceOfAnotherProcess, FeelsTheCubeAndIsLeftWithoutForce) {
  hold(Vec3(0.0, 0.0, 0.125));
  test::Background feel(test::tandemProgram(), {"device", "--device", "falcon@" + port.path()});
  while (feel.readLine().find("end with Ctrl-C") == std::string::npos) {
  }
  hold(Vec3(0.0, -0.018, 0.125));
  EXPECT_TRUE(waitUntil([&] { return readForceUp() > 1.0; }));
  const Outcome outcome = feel.finish(GetParam());
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  EXPECT_EQ(readForceUp(), 0.0);
  port.visit([](FalconEmulator& emulator, double) {
    EXPECT_EQ(emulator.command().motors, FalconMotors{});
    EXPECT_EQ(emulator.command().lights, 0);
    EXPECT_EQ(emulator.strange(), 0U);
  });
}
INSTANTIATE_TEST_SUITE_P(Signals, DeviceOfAnotherProcess,
                         ::testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST(FalconOfAnotherProcess, LoadsTheImageThatItIsGiven) {
  const TempFolder folder;
  const FirmwareImage image = makeSyntheticFirmware(5, 64);
  const std::string file =
      folder.write("image.bin", std::string(image.bytes.begin(), image.bytes.end()));
  EmulatedFalconPort port;
  const Outcome outcome = runTandem(
      {"device", "info", "--device", "falcon@" + port.path(), "--firmware", file, "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["state"], "unhomed");
}

TEST(FalconOfAnotherProcess, SaysThatThereIsNoFirmware) {
  EmulatedFalconPort port;
  const Outcome outcome =
      runTandem({"device", "home", "--device", "falcon@" + port.path(), "--quiet"});
  expectRefused(outcome, 1, {port.path(), "no firmware", "path of the image"});
  // The device is not homed, so the wait ends. How long a process needs to hear it depends on the
  // machine.
  FalconEmulatorSettings settings;
  settings.runs = true;
  EmulatedFalconPort running(settings);
  Outcome unhomed;
  for (int wait = 1; wait <= 32 && unhomed.err.find("homing") == std::string::npos; wait *= 2)
    unhomed = runTandem({"device", "home", "--device", "falcon@" + running.path(), "--quiet",
                         "--wait", std::to_string(wait)});
  expectRefused(unhomed, 1, {"not ready within", "homing"});
}

}  // namespace
}  // namespace tandem
