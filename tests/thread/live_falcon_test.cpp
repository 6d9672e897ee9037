// The live path from bytes to newtons. An emulated Falcon sits behind a pseudo terminal, with a
// driver thread, a haptic thread and a host thread. A hand leans against a wall of the host's world
// while faults occur. The emulated device reports the force that the hand felt.

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "tandem/falcon/byte_transport.h"
#include "tandem/falcon/emulated_falcon_port.h"
#include "tandem/falcon/falcon_device.h"
#include "tandem/falcon/guarded_device.h"
#include "tandem/plugin/haptic_loop.h"

#include "bridge/bullet_rig.h"
#include "falcon/src/novint/falcon_emulator.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using namespace std::chrono_literals;

constexpr double kLean = 3.0;  ///< push of the hand against the wall [N]
/// Limits of the felt force. The margin covers a grip that moves while a command is on its way.
constexpr double kMostForce = 8.0 * 1.06, kMostRise = 2.0 * 1.1;
constexpr double kRamp = 0.1;     ///< [s]
constexpr auto kPatience = 120s;  ///< longest wait on a busy machine

FalconEmulatorSettings makeEmulated() {
  FalconEmulatorSettings settings;
  settings.runs = settings.is_homed = true;
  settings.plant.viscous = 4.0;
  settings.watchdog = 0.5;
  return settings;
}

FalconSettings makePatient() {
  FalconSettings settings;
  settings.reply_time = 0.3;  // a busy machine must not count as a device fault
  settings.quiet_time = 0.3;
  settings.force.ramp_in = kRamp;
  settings.thread_priority = 81;  // used if the system grants it
  settings.firmware_time = 1.0;
  return settings;
}

/// Passes all calls on, and hangs on request.
class HangingDevice final : public HapticDevice {
 public:
  explicit HangingDevice(HapticDevice& device) : device_(device) {}
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return device_.capabilities();
  }
  [[nodiscard]] DeviceSample read(double now) noexcept override {
    while (hangs.load(std::memory_order_relaxed)) std::this_thread::sleep_for(1ms);
    return device_.read(now);
  }
  void write(const Vec3& f_W) noexcept override { device_.write(f_W); }

  std::atomic<bool> hangs{false};

 private:
  HapticDevice& device_;
};

class LiveFalcon : public ::testing::Test {
 protected:
  LiveFalcon() : port(makeEmulated(), makeConstantHand(Vec3(0.0, kLean, 0.0)), 82) {
    auto& wall = rig.makeShape<btBoxShape>(toBullet(Vec3(1, 0.5, 1)));
    rig.addBody(wall, 0.0, Vec3(0.0, 0.53, 0.0));
    EXPECT_TRUE(waitUntil([&] { return guarded.read(0.0).valid; })) << "it was not ready";
    SiteSettings settings;
    settings.tick_source = TickSource::kCaller;
    settings.contact = {600.0, 2.0};
    // Ticks that are late make a wall active. Its account of energy would then be empty and the
    // wall soft for good, so on a busy machine nothing of the way to the hand would be seen.
    settings.passivity.enabled = false;
    site = std::make_unique<Site>(settings, rig.world, device);
    site->connect(PeerId{2}, nobody, Vec3(0.0, -0.5, 0.0));
    loop = std::make_unique<HapticLoop>(
        *site,
        HapticLoopSettings{.priority = 80, .locks_memory = false, .begin = {}, .duration = 1e9});
    host = std::thread([this] {
      while (!stops) {
        std::this_thread::sleep_for(16ms);
        if (!host_rests) rig.world.stepSimulation(btScalar(1.0 / 60.0), 0);
      }
    });
    EXPECT_TRUE(waitUntil([&] { return lean() > 0.8 * kLean; })) << "the wall was not felt";
    std::this_thread::sleep_for(500ms);  // until the impact has decayed
  }

  ~LiveFalcon() override {
    device.hangs = false;
    stops = true;
    host.join();
    loop->stop();
    EXPECT_EQ(guarded.status().force, Vec3(Vec3::Zero()));
    port.visit([](FalconEmulator& emulator, double) {
      EXPECT_LE(emulator.felt().most_force, kMostForce);
      EXPECT_LE(emulator.felt().most_rise, kMostRise);
      EXPECT_GT(emulator.felt().most_force, 0.5 * kLean);
    });
  }

  static bool waitUntil(const std::function<bool()>& holds) {
    for (const auto end = std::chrono::steady_clock::now() + kPatience;
         std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(2ms))
      if (holds()) return true;
    return holds();
  }

  /// Force of the device against the hand [N].
  double lean() {
    double force = 0.0;
    port.visit([&](FalconEmulator& emulator, double) { force = -emulator.plant().force().y(); });
    return force;
  }
  bool isForceGone() {
    return waitUntil([&] { return lean() == 0.0; });
  }
  bool isForceBack() {
    return waitUntil([&] { return lean() > 0.8 * kLean; });
  }

  EmulatedFalconPort port;
  GuardedDevice guarded{std::make_unique<FalconDevice>(makePatient(), makeSyntheticFirmware(7),
                                                       [this] { return openTty(port.path()); }),
                        {.max_force = 8.0, .max_slew = 2000.0, .ramp = kRamp}};
  HangingDevice device{guarded};
  test::BulletRig rig;
  test::FakeLink nobody;
  std::unique_ptr<Site> site;
  std::unique_ptr<HapticLoop> loop;
  std::atomic<bool> stops{false}, host_rests{false};
  std::thread host;
};

TEST_F(LiveFalcon, AWallIsFelt) {
  EXPECT_TRUE(waitUntil([&] { return std::abs(lean() - kLean) < 0.1 * kLean; }));
}

TEST_F(LiveFalcon, AHostThatRestsForTwoSecondsIsNotFelt) {
  host_rests = true;
  std::this_thread::sleep_for(2s);
  EXPECT_TRUE(isForceBack()) << "the wall is the island's: it stands without the host";
  host_rests = false;
  EXPECT_TRUE(isForceBack());
}

TEST_F(LiveFalcon, ACableThatIsPulledAndPluggedInAgain) {
  port.unplug();
  EXPECT_TRUE(isForceGone());  // only the emulated device's own watchdog can do this
  port.plugIn();
  EXPECT_TRUE(isForceBack());
}

TEST_F(LiveFalcon, RepliesThatStayAway) {
  port.visit([](FalconEmulator& emulator, double) {
    emulator.mishaps.silent_replies = FalconMishaps::kAlways;
  });
  EXPECT_TRUE(isForceGone());
  port.visit([](FalconEmulator& emulator, double) { emulator.mishaps.silent_replies = 0; });
  EXPECT_TRUE(isForceBack());
}

TEST_F(LiveFalcon, HomingThatIsLostHasNoForce) {
  port.visit([](FalconEmulator& emulator, double) { emulator.loseHoming(); });
  EXPECT_TRUE(isForceGone());
  bool was_invalid = false;
  site->betweenTicks([&] { was_invalid = (site->status() & kDeviceInvalid) != 0; });
  EXPECT_TRUE(was_invalid);
}

TEST_F(LiveFalcon, APowerCycleIsBootedAndWaitsToBeHomed) {
  port.visit([](FalconEmulator& emulator, double now) {
    emulator.switchOff(now);
    emulator.switchOn(now);
  });
  EXPECT_TRUE(isForceGone());
  EXPECT_TRUE(waitUntil([&] {
    bool runs = false;
    port.visit([&](FalconEmulator& emulator, double) {
      runs = emulator.state() == FalconEmulator::State::kRunning;
    });
    return runs;
  }));
  EXPECT_EQ(lean(), 0.0);
}

TEST_F(LiveFalcon, AHapticThreadThatHangsIsCutByTheDriver) {
  device.hangs = true;
  EXPECT_TRUE(isForceGone());
  device.hangs = false;
  EXPECT_TRUE(isForceBack());
  EXPECT_GT(loop->report().skipped, 0u);
}

}  // namespace
}  // namespace tandem
