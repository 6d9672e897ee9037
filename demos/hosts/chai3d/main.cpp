// CHAI3D's Bullet world with Tandem attached: two users and one cube, 50 ms apart. User 1 holds the
// first haptic device that CHAI3D finds; without one, a simulated hand pushes with 5 N. User 2 is
// simulated.
//
// The program draws nothing: the cube is a cBulletBox like any other of your scene.

#include <cstdio>
#include <memory>

#include <CBullet.h>
#include <chai3d.h>

#include "tandem/coordination/simulated_link.h"
#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

#include "chai3d_device.h"

/// A CHAI3D program's own world: one cube of 4 cm and 200 g, no gravity.
struct Scene {
  chai3d::cBulletWorld world;
  chai3d::cBulletBox* cube =
      new chai3d::cBulletBox(&world, 0.04, 0.04, 0.04);  // the world deletes it

  Scene() {
    world.setGravity(0.0, 0.0, 0.0);
    world.addChild(cube);
    cube->setMass(0.2);
    cube->estimateInertia();
    cube->buildDynamicModel();
  }
};

/// The first device that CHAI3D finds, or a simulated one with a hand that pushes along x.
std::unique_ptr<tandem::HapticDevice> openDevice(const tandem::SimulatedDeviceSettings& simulated) {
  chai3d::cHapticDeviceHandler handler;
  chai3d::cGenericHapticDevicePtr device;
  if (handler.getNumDevices() > 0 && handler.getDevice(device, 0))
    return std::make_unique<Chai3dDevice>(device);
  std::printf("no haptic device found; a simulated hand pushes with 5 N\n");
  return std::make_unique<tandem::SimulatedDevice>(simulated, tandem::makeConstantHand({5, 0, 0}));
}

int main() {
  tandem::SimulatedDeviceSettings left, right;
  left.start_W.x() = -0.03, right.start_W.x() = 0.03;
  const auto [to_there, to_here] = tandem::makeSimulatedLinks({.delay = 0.05});
  const auto device1 = openDevice(left);
  tandem::SimulatedDevice device2(right, tandem::makeConstantHand({0, 0, 0}));

  Scene here, there;  // outlive the sites
  tandem::SiteSettings settings;
  settings.guide = tandem::Vec3::UnitX();  // a slot along x, as in Experiment I
  tandem::Site site1(settings, *here.world.getBulletWorld(), *device1);
  site1.share(*here.cube->m_bulletRigidBody);
  site1.connect(tandem::PeerId{2}, *to_there, right.start_W);

  settings.self = tandem::PeerId{2};
  tandem::Site site2(settings, *there.world.getBulletWorld(), device2);
  site2.share(*there.cube->m_bulletRigidBody);
  site2.connect(tandem::PeerId{1}, *to_here, left.start_W);

  // Steps like CHAI3D's haptic thread. Its world runs at most ten sub-steps of 1 ms per call and
  // drops the rest. Intervals above 10 ms would slow time down.
  for (int step = 0; step < 1000; ++step) {
    here.world.updateDynamics(1e-3);
    there.world.updateDynamics(1e-3);
  }
  std::printf("cube at %.4f m here, %.4f m there; force on user 1: %.3f N\n",
              here.cube->getLocalPos().x(), there.cube->getLocalPos().x(), site1.force().x());
}
