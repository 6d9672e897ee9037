// A host in C++17 with its own world. It uses all of the package except the devices.
#include <cstdio>
#include <string>

#include <btBulletDynamicsCommon.h>

#include "tandem/coordination/simulated_link.h"
#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/secret_key.h"
#include "tandem/plugin/site.h"

namespace {

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

/// One user pushes a cube for a second. Returns its final place [m].
double pushAlone() {
  Host host;
  tandem::SimulatedDeviceSettings start;
  start.start_W.x() = -0.03;
  tandem::SimulatedDevice device(start, tandem::makeConstantHand({5, 0, 0}));
  tandem::SiteSettings settings;
  settings.guide = tandem::Vec3::UnitX();
  tandem::Site site(settings, host.world, device);
  site.share(host.cube);
  for (int step = 0; step < 60; ++step) host.world.stepSimulation(btScalar(1.0 / 60.0));
  return double(host.cube.getCenterOfMassPosition().x());
}

/// The error text when a second site is attached to a world.
std::string attachTwice() {
  Host host;
  tandem::SimulatedDevice device({}, tandem::makeConstantHand({0, 0, 0}));
  tandem::Site first({}, host.world, device);
  try {
    tandem::Site second({}, host.world, device);
  } catch (const tandem::Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

int main() {
  const double pushed = pushAlone();
  const std::string refused = attachTwice();
  const tandem::SecretKey key = tandem::SecretKey::generate();
  if (!(pushed > 0.01) || refused.empty() || key.isEmpty()) {
    std::fprintf(stderr, "pushed %.4f m, refused with \"%s\"\n", pushed, refused.c_str());
    return 1;
  }
  std::printf("cube pushed to %.4f m; refused: %s\n", pushed, refused.c_str());
}
