// Two worlds in two threads, each stepped at its own 60 Hz in real time, with a haptic thread each
// at 1 kHz. The main thread is the network between them.

#include <chrono>
#include <cstdio>
#include <thread>

#include <btBulletDynamicsCommon.h>

#include "tandem/coordination/simulated_link.h"
#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/haptic_loop.h"
#include "tandem/plugin/link_queue.h"

using Clock = std::chrono::steady_clock;

constexpr double kDuration = 1.5;  // [s]

/// A user with a device, at y, and the user's world with a cube.
struct User {
  btBoxShape block{btVector3(0.02, 0.02, 0.02)};
  btRigidBody cube{0.2, nullptr, &block, btVector3(5.3e-5, 5.3e-5, 5.3e-5)};
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  tandem::SimulatedDevice device;
  tandem::LinkQueue queue;
  tandem::Site site;

  User(unsigned self, double y, double push, double other_y)
      : device(makeSettings(y), tandem::makeConstantHand({0, push, 0})),
        site(makeSiteSettings(self), world, device) {
    world.setGravity(btVector3(0, 0, 0));
    world.addRigidBody(&cube);
    site.share(cube);
    site.connect(tandem::PeerId{3 - self}, queue, tandem::Vec3(0, other_y, 0));
  }
  static tandem::SimulatedDeviceSettings makeSettings(double y) {
    tandem::SimulatedDeviceSettings settings;
    settings.start_W.y() = y;
    settings.damping = 5.0;
    return settings;
  }
  static tandem::SiteSettings makeSiteSettings(unsigned self) {
    tandem::SiteSettings settings;
    settings.self = tandem::PeerId{self};
    settings.tick_source = tandem::TickSource::kCaller;  // the loop's
    return settings;
  }
  /// The host's loop.
  void run() {
    tandem::HapticLoopSettings modest;
    modest.priority = 0;  // 80 where the system grants real-time priority
    modest.locks_memory = false;
    const tandem::HapticLoop loop(site, modest);
    auto next = Clock::now();
    for (int step = 0; step < static_cast<int>(kDuration * 60.0); ++step) {
      next += std::chrono::microseconds(16667);
      std::this_thread::sleep_until(next);
      world.stepSimulation(1.0 / 60.0, 0);
    }
  }
  double y() const { return cube.getCenterOfMassPosition().y(); }
};

int main() {
  User one(1, -0.031, 1.0, 0.1), two(2, 0.1, 0.0, -0.031);
  tandem::Impairments network;
  network.delay = 0.02;
  const auto links = tandem::makeSimulatedLinks(network);
  std::thread first([&] { one.run(); }), second([&] { two.run(); });
  const auto begin = Clock::now();
  for (double now = 0.0; now < kDuration;) {
    now = std::chrono::duration<double>(Clock::now() - begin).count();
    one.queue.exchange(*links.first, now, now + 2e-3);
    two.queue.exchange(*links.second, now, now + 2e-3);
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  first.join();
  second.join();
  std::printf("cube at %.3f m here, %.3f m there; status %u and %u\n", one.y(), two.y(),
              one.site.status(), two.site.status());
  const bool has_moved = one.y() > 0.01 && two.y() > 0.01;
  std::puts(has_moved ? "both copies were pushed" : "a copy stayed where it was");
  return has_moved ? 0 : 1;
}
