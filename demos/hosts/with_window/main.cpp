// A program with a Bullet world of its own, in a window. The mouse is in the user's hand, pushes a
// cube on a floor, and shows the force. With a number as argument it ends after that many seconds.

#include <cstdio>
#include <cstdlib>
#include <exception>

#include <btBulletDynamicsCommon.h>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/falcon/mouse_device.h"
#include "tandem/plugin/haptic_loop.h"
#include "tandem/plugin/site.h"

#include "window/window.h"

/// The host, without any part of Tandem.
struct Host {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btStaticPlaneShape ground{btVector3(0, 0, 1), 0};
  btBoxShape block{btVector3(0.02, 0.02, 0.02)};
  btRigidBody floor{0, nullptr, &ground};
  btRigidBody cube{0.2, nullptr, &block, btVector3(5.3e-5, 5.3e-5, 5.3e-5)};

  Host() {
    world.setGravity(btVector3(0, 0, -9.81));
    cube.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, 0.02)));
    for (btRigidBody* body : {&floor, &cube}) world.addRigidBody(body);
  }
  ~Host() {
    for (btRigidBody* body : {&floor, &cube}) world.removeRigidBody(body);
  }
};

void run(double duration) {
  Host host;
  tandem::MouseSettings hand;
  hand.start_W = tandem::Vec3(-0.06, 0, 0.02);
  tandem::MouseDevice mouse(hand);

  tandem::SiteSettings settings;
  settings.peers = 1;  // nobody else
  settings.tick_source = tandem::TickSource::kCaller;
  settings.host_step = 1.0 / 60.0;
  settings.contact = {2000.0, 5.0};
  tandem::Site site(settings, host.world, mouse);
  site.share(host.cube);

  tandem::HapticLoop loop(site);
  tandem::view::Window window(site, host.world, &mouse);
  const double end = tandem::readMonotonicClock() + duration;
  while (window.show() && tandem::readMonotonicClock() < end)
    host.world.stepSimulation(1.0 / 60.0, 0);
  loop.stop();
  std::printf("cube at %.3f, %.3f m; %llu ticks, status %u\n",
              host.cube.getCenterOfMassPosition().x(), host.cube.getCenterOfMassPosition().y(),
              static_cast<unsigned long long>(loop.report().ticks), site.status());
}

int main(int argc, char** argv) {
  try {
    run(argc > 1 ? std::atof(argv[1]) : 1e9);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "with_window: %s\n", error.what());
    return 1;
  }
}
