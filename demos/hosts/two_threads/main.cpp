// Two sites in one program, over UDP. Each has a world in its own thread, stepped at 60 Hz in real
// time. Each also has a haptic thread at 1 kHz and a thread for its socket.

#include <array>
#include <cstdio>
#include <thread>
#include <utility>

#include <btBulletDynamicsCommon.h>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/haptic_loop.h"
#include "tandem/plugin/live_peers.h"

constexpr double kDuration = 2.0, kStep = 1.0 / 60.0;  // [s]

/// A user with a device at y, and the user's world with a cube.
struct User {
  btBoxShape block{btVector3(0.02, 0.02, 0.02)};
  btRigidBody cube{0.2, nullptr, &block, btVector3(5.3e-5, 5.3e-5, 5.3e-5)};
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  tandem::SimulatedDevice device;
  tandem::LivePeers peers;
  tandem::Site site;

  /// `other` is the other user's address; empty: waits for the other's call.
  User(unsigned self, double y, double push, double other_y, std::optional<tandem::Address> other)
      : device(makeSettings(y), tandem::makeConstantHand({0, push, 0})),
        peers(makeConnection(self), makePeers(3 - self, other)),
        site(makeSiteSettings(self), world, device) {
    world.setGravity(btVector3(0, 0, 0));
    world.addRigidBody(&cube);
    site.share(cube);
    const tandem::PeerId peer{3 - self};
    site.connect(peer, peers.link(peer), tandem::Vec3(0, other_y, 0));
  }
  static tandem::SimulatedDeviceSettings makeSettings(double y) {
    tandem::SimulatedDeviceSettings settings;
    settings.start_W.y() = y;
    settings.damping = 5.0;
    return settings;
  }
  static tandem::UdpMeshSettings makeConnection(unsigned self) {
    tandem::UdpMeshSettings settings;
    settings.self = tandem::PeerId{self};
    settings.bind = tandem::resolveAddress("127.0.0.1:0");
    settings.configuration = tandem::makeConfiguration({{"object.mass", "0.2"}});
    return settings;
  }
  static std::vector<tandem::UdpPeer> makePeers(unsigned peer,
                                                std::optional<tandem::Address> address) {
    // A real program reads a key file: tandem/plugin/key_file.h.
    std::array<std::uint8_t, tandem::SecretKey::kSize> key;
    key.fill(42);
    std::vector<tandem::UdpPeer> peers;
    peers.push_back({tandem::PeerId{peer}, address, tandem::SecretKey::take(key)});
    return peers;
  }
  static tandem::SiteSettings makeSiteSettings(unsigned self) {
    tandem::SiteSettings settings;
    settings.self = tandem::PeerId{self};
    settings.tick_source = tandem::TickSource::kCaller;  // the loop ticks
    return settings;
  }
  /// The host's loop.
  void run() {
    peers.startThread();
    tandem::HapticLoopSettings modest;
    modest.priority = 0;  // 80 where the system grants real-time priority
    modest.locks_memory = false;
    tandem::HapticLoop loop(site, modest);
    const double begin = tandem::readMonotonicClock();
    for (int step = 1; step <= static_cast<int>(kDuration / kStep); ++step) {
      tandem::sleepUntil(begin + step * kStep);
      world.stepSimulation(kStep, 0);
    }
    loop.stop();
    peers.sayFarewell();
  }
  double y() const { return cube.getCenterOfMassPosition().y(); }
};

int main() {
  User two(2, 0.1, 0.0, -0.031, std::nullopt);
  User one(1, -0.031, 1.0, 0.1, two.peers.bound());
  std::thread second([&] { two.run(); });
  one.run();
  second.join();
  std::printf("cube at %.3f m here, %.3f m there; status %u and %u\n", one.y(), two.y(),
              one.site.status(), two.site.status());
  const bool has_moved = one.y() > 0.01 && two.y() > 0.01;
  std::puts(has_moved ? "both copies were pushed" : "a copy stayed where it was");
  return has_moved ? 0 : 1;
}
