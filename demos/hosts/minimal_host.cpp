#include <cstdio>

#include <btBulletDynamicsCommon.h>

#include "tandem/coordination/simulated_link.h"
#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

/// Any program with a Bullet world: one cube of 4 cm and 200 g, no gravity, no part of Tandem.
struct Host {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btBoxShape shape{btVector3(0.02, 0.02, 0.02)};
  btRigidBody cube{0.2, nullptr, &shape, btVector3(5.3e-5, 5.3e-5, 5.3e-5)};

  Host() {
    world.setGravity(btVector3(0, 0, 0));
    world.addRigidBody(&cube);
  }
  ~Host() { world.removeRigidBody(&cube); }
};

// README: the code block of README.md is what stands from here to the next such line.
int main() {
  Host here, there;  // two users' programs, each with a Bullet world and a cube
  const auto [to_there, to_here] = tandem::makeSimulatedLinks({.delay = 0.05});

  // A device each, just in contact with the cube. User 1 pushes with 5 N, user 2's hand is empty.
  tandem::SimulatedDeviceSettings left, right;
  left.start_W.x() = -0.03, right.start_W.x() = 0.03;
  tandem::SimulatedDevice device1(left, tandem::makeConstantHand({5, 0, 0}));
  tandem::SimulatedDevice device2(right, tandem::makeConstantHand({0, 0, 0}));

  tandem::SiteSettings settings;           // the gains, masses and rates of Experiment I
  settings.guide = tandem::Vec3::UnitX();  // a slot along x; without it bodies move and turn freely
  tandem::Site site1(settings, here.world, device1);
  site1.share(here.cube);
  site1.connect(tandem::PeerId{2}, *to_there, right.start_W);

  settings.self = tandem::PeerId{2};
  tandem::Site site2(settings, there.world, device2);
  site2.share(there.cube);
  site2.connect(tandem::PeerId{1}, *to_here, left.start_W);

  for (int step = 0; step < 60; ++step) {   // one second
    here.world.stepSimulation(1.0 / 60.0);  // runs the 1 kHz ticks of this step inside
    there.world.stepSimulation(1.0 / 60.0);
  }
  std::printf("cube at %.4f m here, %.4f m there; force on user 1: %.3f N\n",
              here.cube.getCenterOfMassPosition().x(), there.cube.getCenterOfMassPosition().x(),
              site1.force().x());
}
// README
