// A host with its own tick callbacks and its own use of the world's user pointer. Bullet has one
// place for each. A site leaves them to the host, and calls the callbacks that it found there.

#include <cstdio>

#include <btBulletDynamicsCommon.h>

#include "tandem/coordination/simulated_link.h"
#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

/// A weightless cube in a breeze, which the host applies in its pre-tick.
struct Host {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btBoxShape block{btVector3(0.02, 0.02, 0.02)};
  btRigidBody cube{0.2, nullptr, &block, btVector3(5.3e-5, 5.3e-5, 5.3e-5)};
  int before = 0, after = 0;  // calls

  Host() {
    world.setGravity(btVector3(0, 0, 0));
    world.addRigidBody(&cube);
    world.setInternalTickCallback(blow, this, true);
    world.setInternalTickCallback(count, this, false);
  }
  ~Host() { world.removeRigidBody(&cube); }

  static void blow(btDynamicsWorld* world, btScalar dt) {
    auto* host = static_cast<Host*>(world->getWorldUserInfo());
    ++host->before;
    host->cube.applyCentralImpulse(btVector3(0, 0.1, 0) * dt);  // 0.1 N
  }
  static void count(btDynamicsWorld* world, btScalar) {
    ++static_cast<Host*>(world->getWorldUserInfo())->after;
  }
  /// Steps one second in several calls of four sub-steps each.
  void run() {
    for (int call = 0; call < 60; ++call) world.stepSimulation(1.0 / 60.0, 4, 1.0 / 240.0);
  }
};

int main() {
  Host host;
  tandem::SimulatedDeviceSettings at;
  at.start_W.x() = -0.1;
  tandem::SimulatedDevice device(at, tandem::makeConstantHand({0, 0, 0}));
  {
    tandem::SiteSettings settings;
    settings.peers = 1;  // no other peer carries the cube
    tandem::Site site(settings, host.world, device);
    site.share(host.cube);
    host.run();
    // v = F t / m
    std::printf("attached: %d and %d calls, cube at %.3f m/s\n", host.before, host.after,
                host.cube.getLinearVelocity().y());
  }
  host.run();
  std::printf("afterwards: %d and %d calls, cube at %.3f m/s\n", host.before, host.after,
              host.cube.getLinearVelocity().y());
}
