// A program with a Bullet world: a cube and a box on a floor. Two users push the cube, each in a
// world of their own. Here both are in one program, with 50 ms between them.

#include <cstdio>

#include <btBulletDynamicsCommon.h>

#include "tandem/coordination/simulated_link.h"
#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

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
  btRigidBody box{0.1, nullptr, &block, btVector3(2.7e-5, 2.7e-5, 2.7e-5)};

  Host() {
    world.setGravity(btVector3(0, 0, -9.81));
    cube.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, 0.02)));
    box.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0.06, 0, 0.02)));
    for (btRigidBody* body : {&floor, &cube, &box}) {
      body->setFriction(0.5);
      world.addRigidBody(body);
    }
  }
  ~Host() {
    for (btRigidBody* body : {&floor, &cube, &box}) world.removeRigidBody(body);
  }
};

/// A simulated device at x, and the force of its hand.
tandem::SimulatedDevice makeDevice(double x, double push) {
  tandem::SimulatedDeviceSettings settings;
  settings.start_W = tandem::Vec3(x, 0, 0.02);
  settings.damping = 5.0;
  return {settings, tandem::makeConstantHand({push, 0, 0})};
}

int main() {
  Host here, there;
  tandem::Impairments network;
  network.delay = 0.05;
  const auto links = tandem::makeSimulatedLinks(network);
  tandem::SimulatedDevice left = makeDevice(-0.03, 1.5), right = makeDevice(-0.2, 0.0);
  {
    tandem::SiteSettings settings;
    tandem::Site site1(settings, here.world, left);
    site1.share(here.cube);
    site1.connect(tandem::PeerId{2}, *links.first, tandem::Vec3(-0.2, 0, 0.02));

    settings.self = tandem::PeerId{2};
    tandem::Site site2(settings, there.world, right);
    site2.share(there.cube);
    site2.connect(tandem::PeerId{1}, *links.second, tandem::Vec3(-0.03, 0, 0.02));
    for (const std::string& line : site1.warnings()) std::printf("note: %s\n", line.c_str());

    for (int step = 0; step < 60; ++step) {
      here.world.stepSimulation(1.0 / 60.0);
      there.world.stepSimulation(1.0 / 60.0);
    }
    std::printf("cube at %.3f m here, %.3f m there; box at %.3f and %.3f m; status %u and %u\n",
                here.cube.getCenterOfMassPosition().x(), there.cube.getCenterOfMassPosition().x(),
                here.box.getCenterOfMassPosition().x(), there.box.getCenterOfMassPosition().x(),
                site1.status(), site2.status());
    std::printf("while shared each copy has %.2f kg", here.cube.getMass());
  }
  std::printf(", afterwards %.2f kg\n", here.cube.getMass());
}
