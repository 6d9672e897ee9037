// A program with a working site. It then loads a module for the other width of Bullet, which has
// all the same names, and steps on.  usage: one_width MODULE local|global
#include <cmath>
#include <cstdio>
#include <string>

#include <dlfcn.h>

#include <btBulletDynamicsCommon.h>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

namespace {

void loadOtherWidth(const char* module, bool for_all) {
  void* const loaded = dlopen(module, RTLD_NOW | (for_all ? RTLD_GLOBAL : RTLD_LOCAL));
  if (loaded == nullptr) {
    std::printf("%s\n", dlerror());
    return;
  }
  using Attach = void (*)(char*, int);
  const auto attach = reinterpret_cast<Attach>(dlsym(loaded, "attachSite"));
  char answer[1000] = "";
  attach(answer, sizeof answer);
  std::printf("%s\n", answer);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, 0, 0));
  btBoxShape shape(btVector3(btScalar(0.02), btScalar(0.02), btScalar(0.02)));
  btRigidBody cube(btScalar(0.2), nullptr, &shape, btVector3(1, 1, 1) * btScalar(5.3e-5));
  world.addRigidBody(&cube);

  tandem::SimulatedDeviceSettings start;
  start.start_W.x() = -0.03;
  tandem::SimulatedDevice device(start, tandem::makeConstantHand({5, 0, 0}));
  {
    tandem::Site site({}, world, device);
    site.share(cube);
    for (int step = 0; step < 30; ++step) world.stepSimulation(btScalar(1.0 / 60.0));
    const btScalar before = cube.getCenterOfMassPosition().x();
    loadOtherWidth(arguments[1], arguments[2] == std::string("global"));
    for (int step = 0; step < 30; ++step) world.stepSimulation(btScalar(1.0 / 60.0));
    const btScalar after = cube.getCenterOfMassPosition().x();
    if (!std::isfinite(after) || !(after > before)) {
      std::printf("the cube went from %g to %g m\n", double(before), double(after));
      return 1;
    }
  }
  world.removeRigidBody(&cube);
  std::printf("the site here went on\n");
}
