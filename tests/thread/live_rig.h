#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

#include "tandem/coordination/simulated_link.h"
#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/haptic_loop.h"
#include "tandem/plugin/link_queue.h"

#include "bridge/bullet_rig.h"

namespace tandem::test {

/// A device that records the force written to it. Its read() may be slow.
class WatchedDevice final : public HapticDevice {
 public:
  explicit WatchedDevice(HapticDevice& device) : device_(device), limits_(device.capabilities()) {
    limits_.max_force = 8.0;
    limits_.max_slew = 2000.0;
  }
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override { return limits_; }
  [[nodiscard]] DeviceSample read(double now) noexcept override {
    if (dawdles_every > 0 && ++reads_ % dawdles_every == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    DeviceSample sample = device_.read(now);
    sample.valid &= !is_unplugged.load(std::memory_order_relaxed);
    return sample;
  }
  void write(const Vec3& f_W) noexcept override {
    device_.write(f_W);
    is_finite &= f_W.allFinite();
    largest = std::max(largest, f_W.norm());
    largest_rise = std::max(largest_rise, f_W.norm() - last_W.norm());
    last_W = f_W;
  }

  std::atomic<bool> is_unplugged{false};
  int dawdles_every = 0;
  // For the haptic thread, or for any thread when there is none.
  Vec3 last_W = Vec3::Zero();
  double largest = 0.0, largest_rise = 0.0;
  bool is_finite = true;

 private:
  HapticDevice& device_;
  DeviceCapabilities limits_;
  int reads_ = 0;
};

/// In a host's world, a hand pushes a cube on a floor into boxes.
struct LiveSite {
  static constexpr double kHostPeriod = 1.0 / 60.0;

  /// `link`: instead of `queue`.
  LiveSite(int self, const Vec3& hand_force, int boxes = 3, Link* link = nullptr,
           const MembershipSettings& membership = {})
      : rig(Vec3(0.0, 0.0, -9.81)), device(makeSettings(self), makeConstantHand(hand_force)) {
    auto& floor = rig.makeShape<btBoxShape>(toBullet(Vec3(2, 2, 0.5)));
    rig.addBody(floor, 0.0, Vec3(0.0, 0.0, -0.52));
    auto& box = rig.makeShape<btBoxShape>(toBullet(Vec3(0.02, 0.02, 0.02)));
    cube = &rig.addBody(box, 0.2);
    for (int i = 0; i < boxes; ++i) rig.addBody(box, 0.2, Vec3(0.0, 0.045 + 0.041 * i, 0.0));

    SiteSettings settings;
    settings.self = PeerId{static_cast<std::uint32_t>(self)};
    settings.tick_source = TickSource::kCaller;
    settings.contact = {2000.0, 1.0};
    settings.membership = membership;
    if (boxes == 0) settings.coordination = {0.0, 0.0};  // nothing holds the cube back
    site = std::make_unique<Site>(settings, rig.world, watched);
    site->share(*cube);
    site->connect(PeerId{static_cast<std::uint32_t>(3 - self)}, link ? *link : queue,
                  makeSettings(3 - self).start_W);
  }

  static SimulatedDeviceSettings makeSettings(int self) {
    SimulatedDeviceSettings settings;
    settings.start_W = self == 1 ? Vec3(0.0, -0.031, 0.0) : Vec3(0.06, 0.1, 0.0);
    settings.damping = 5.0;
    return settings;
  }

  /// Runs the host in this thread for `seconds`, in real time or `speed` times as fast.
  void host(double seconds, double speed = 1.0) {
    auto next = std::chrono::steady_clock::now();
    for (int step = 0; step < static_cast<int>(seconds / kHostPeriod); ++step) {
      next += std::chrono::duration_cast<std::chrono::steady_clock::duration>(
          std::chrono::duration<double>(kHostPeriod / speed));
      std::this_thread::sleep_until(next);
      rig.world.stepSimulation(static_cast<btScalar>(kHostPeriod), 0);
    }
  }

  BulletRig rig;
  SimulatedDevice device;
  WatchedDevice watched{device};
  LinkQueue queue;
  btRigidBody* cube = nullptr;
  std::unique_ptr<Site> site;
};

/// Thread that takes the place of two sites' sockets.
class Wire {
 public:
  Wire(LinkQueue& a, LinkQueue& b)
      : links_(makeSimulatedLinks({.delay = 0.02})), thread_([this, &a, &b] { run(a, b); }) {}
  ~Wire() {
    stops_ = true;
    thread_.join();
  }

 private:
  void run(LinkQueue& a, LinkQueue& b) {
    const double begin = readMonotonicClock();
    while (!stops_) {
      const double now = readMonotonicClock() - begin;
      a.exchange(*links_.first, now, now + 2e-3);
      b.exchange(*links_.second, now, now + 2e-3);
      std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
  }

  std::pair<std::unique_ptr<SimulatedLink>, std::unique_ptr<SimulatedLink>> links_;
  std::atomic<bool> stops_{false};
  std::thread thread_;
};

}  // namespace tandem::test
