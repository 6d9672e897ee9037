// The host of host.cpp in its plain world, but built with Tandem. Its site has the settings of the
// config in host_test.cpp. A preloaded host must give exactly the same result.

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

#include "preload/host_scene.h"

using namespace tandem;
using namespace tandem::test;

int main() {
  Parts parts;
  btDiscreteDynamicsWorld world(&parts.dispatcher, &parts.pairs, &parts.solver,
                                &parts.configuration);
  Scene scene(world);
  scene.addCubes();

  SimulatedDeviceSettings device_settings;
  device_settings.start_W = Vec3(-0.03, 0, 0.02);
  SimulatedDevice device(device_settings, makeConstantHand(Vec3(5, 0, 0)));
  SiteSettings settings;
  settings.peers = 1;
  std::uint64_t state = 0xcbf29ce484222325u;
  Site site(settings, world, device);
  site.share(scene.firstCube());
  for (int step = 0; step < 60; ++step) {
    world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
    scene.hash(state);
  }
  print(state, scene.firstCube());
}
