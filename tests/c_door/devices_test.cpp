// The caller's devices at a site.

#include <limits>

#include "c_door/c_door_rig.h"

namespace tandem {
namespace {

using namespace test;

constexpr double kTick = 1e-3;

/// A site ticked by the test, before a wall that the hand can press.
struct Ticked {
  TandemWorld* world = makeWorld();
  TandemDevice* device;
  TandemSite* site = nullptr;
  double now = 0.0;

  explicit Ticked(TandemDevice* given) : device(given) {
    TandemBodySettings wall = tandem_default_body_settings();
    TandemBody body = TANDEM_NO_BODY;
    ok(tandem_world_add_body(world, &wall, &body));
    TandemSiteSettings settings = tandem_default_site_settings();
    settings.tick_source = TANDEM_TICK_CALLER;
    ok(tandem_site_create(&settings, world, device, &site));
    ok(tandem_site_share(site, body, 0.0, nullptr));
  }
  ~Ticked() {
    ok(tandem_site_destroy(site));
    ok(tandem_world_destroy(world));
    ok(tandem_device_destroy(device));
  }
  Ticked(const Ticked&) = delete;
  Ticked& operator=(const Ticked&) = delete;

  std::uint32_t tick() {
    std::uint32_t status = 0;
    ok(tandem_site_tick(site, now, &status));
    now += kTick;
    return status;
  }
  [[nodiscard]] TandemReading read() const {
    TandemReading reading{};
    ok(tandem_site_read(site, &reading, 0, nullptr, 0, nullptr, nullptr));
    return reading;
  }
  [[nodiscard]] Vec3 force() const {
    double force[3];
    ok(tandem_device_get_force(device, force));
    return test::toVec3(force);
  }
};

TandemDevice* makeMoved() {
  TandemDevice* device = nullptr;
  ok(tandem_device_create_moved(kFarAway, kAnyForce, &device));
  return device;
}

TEST(MovedDevice, GoesOnWithItsVelocityFor50Milliseconds) {
  Ticked ticked(makeMoved());
  const double at[3] = {5.0, 0.0, 0.0}, speed[3] = {0.0, 2.0, 0.0};
  ticked.tick();
  ok(tandem_device_move(ticked.device, at, speed));
  // A tick moves the hand to the end of its motion.
  ticked.tick();
  EXPECT_NEAR(ticked.read().hip[1], kTick * 2.0, 1e-12);
  for (int i = 1; i < 30; ++i) ticked.tick();
  EXPECT_NEAR(ticked.read().hip[1], 30 * kTick * 2.0, 1e-12);
  EXPECT_EQ(ticked.read().hip_velocity[1], 2.0);
  for (int i = 0; i < 100; ++i) ticked.tick();
  EXPECT_NEAR(ticked.read().hip[1], 0.05 * 2.0, 1e-12);
  EXPECT_EQ(ticked.read().hip_velocity[1], 0.0);
}

// K_vc = 4000 N/m, 0.5 mm into the face: 2 N. A float world has the face to half a bit of 2 cm.
TEST(MovedDevice, FeelsWhatItTouches) {
  Ticked ticked(makeMoved());
  const double at[3] = {-0.0295, 0.0, 0.0};
  ticked.tick();  // a hand that starts in the cube would be let in gently
  ok(tandem_device_move(ticked.device, at, kNothing));
  ticked.tick();
  EXPECT_NEAR(ticked.force().x(), -2.0, byDoorWidth(1e-9, 4000.0 * 0.03 * 0x1p-24));
  EXPECT_EQ(ticked.read().force[0], ticked.force().x());
}

/// Callbacks that return the values set by the test.
struct Called {
  Vec3 at{10.0, 0.0, 0.0};
  int is_there = 1, reads = 0;
  Vec3 force_W = Vec3::Zero();

  static int read(void* user, double, double position[3], double velocity[3]) {
    auto& self = *static_cast<Called*>(user);
    ++self.reads;
    for (int i = 0; i < 3; ++i) position[i] = self.at[i], velocity[i] = 0.0;
    return self.is_there;
  }
  static void write(void* user, const double force[3]) {
    static_cast<Called*>(user)->force_W = test::toVec3(force);
  }
  TandemDevice* make() {
    TandemDevice* device = nullptr;
    ok(tandem_device_create({read, write, this}, kAnyForce, &device));
    return device;
  }
};

TEST(CalledDevice, IsReadAndWrittenOnceATick) {
  Called called;
  Ticked ticked(called.make());
  ticked.tick();
  const int before = called.reads;
  called.at.x() = -0.0295;
  EXPECT_EQ(ticked.tick(), 0u);
  EXPECT_EQ(called.reads, before + 1);
  EXPECT_NEAR(called.force_W.x(), -2.0, byDoorWidth(1e-9, 4000.0 * 0.03 * 0x1p-24));
  EXPECT_EQ(ticked.force(), called.force_W);
}

// At 2000 N/s, 2 N fade within two ticks, and return when the device does.
TEST(CalledDevice, WithoutAPositionTheForceFades) {
  for (const bool is_nan : {false, true}) {
    Called called;
    Ticked ticked(called.make());
    ticked.tick();
    called.at.x() = -0.0295;
    ticked.tick();
    EXPECT_NE(called.force_W, Vec3::Zero());
    if (is_nan) {
      called.at.z() = std::numeric_limits<double>::quiet_NaN();
    } else {
      called.is_there = 0;
    }
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(ticked.tick(), std::uint32_t{TANDEM_STATUS_DEVICE_INVALID});
    EXPECT_EQ(called.force_W, Vec3::Zero());
    called = {Vec3(10.0, 0.0, 0.0)};
    EXPECT_EQ(ticked.tick(), 0u);
    EXPECT_EQ(ticked.read().status, std::uint32_t{TANDEM_STATUS_DEVICE_INVALID});
  }
}

TEST(CalledDevice, MustBeThereWhenASiteIsMade) {
  Called called;
  called.is_there = 0;
  TandemDevice* device = called.make();
  TandemWorld* world = makeWorld();
  TandemSite* site = nullptr;
  const TandemSiteSettings settings = tandem_default_site_settings();
  EXPECT_EQ(tandem_site_create(&settings, world, device, &site), TANDEM_CANNOT);
  EXPECT_EQ(site, nullptr);
  ok(tandem_device_destroy(device));  // neither device is in use
  ok(tandem_world_destroy(world));
}

// 5 N on 0.1 kg for 20 ms give 1 m/s, minus the effect of 0.5 N s/m.
TEST(SimulatedDevice, IsPushedByItsHand) {
  TandemDevice* device = nullptr;
  ok(tandem_device_create_simulated(0.1, 0.5, kFarAway, nullptr, &device));
  Ticked ticked(device);
  ticked.tick();
  const double push[3] = {0.0, 5.0, 0.0};
  ok(tandem_device_set_hand(device, push));
  for (int i = 0; i < 20; ++i) ticked.tick();
  const double expected = 5.0 / 0.5 * (1.0 - std::exp(-0.5 / 0.1 * 20 * kTick));
  EXPECT_NEAR(ticked.read().hip_velocity[1], expected, 1e-9);
}

TEST(Tick, DoesNotRunBack) {
  Ticked ticked(makeMoved());
  ok(tandem_site_tick(ticked.site, 0.5, nullptr));
  for (const double now : {0.5, 0.4, std::nan("")}) {
    EXPECT_EQ(tandem_site_tick(ticked.site, now, nullptr), TANDEM_INVALID_ARGUMENT);
    EXPECT_EQ(ticked.read().ticks, 1u);
  }
}

}  // namespace
}  // namespace tandem
