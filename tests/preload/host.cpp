// A foreign program that links dynamically to Bullet and does not know Tandem. It prints a hash
// over the bits of all bodies' states after each step, and the final place of its cube.
//
//   host [--steps N] [--world
//   plain|derived|second|removed|late|callback|in_step|world_first|leaked|none]
//   [--realtime]

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include <time.h>

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include "preload/host_scene.h"

namespace tandem::test {
namespace {

/// The host's own callback removes the first cube in the middle of a step.
void removeInStep(btDynamicsWorld* world, btScalar) {
  static int calls = 0;
  if (++calls == 20) static_cast<Scene*>(world->getWorldUserInfo())->removeFirstCube();
}

int seen_sub_steps = 0;
void countSubSteps(btDynamicsWorld*, btScalar) { ++seen_sub_steps; }

std::unique_ptr<btDiscreteDynamicsWorld> makeWorld(const std::string& kind, Parts& parts) {
  if (kind == "derived")
    return std::make_unique<btMultiBodyDynamicsWorld>(
        &parts.dispatcher, &parts.pairs, &parts.solver_of_derived, &parts.configuration);
  return std::make_unique<btDiscreteDynamicsWorld>(&parts.dispatcher, &parts.pairs, &parts.solver,
                                                   &parts.configuration);
}

void run(const std::string& kind, int steps, bool is_realtime) {
  Parts first_parts, parts;
  std::unique_ptr<btDiscreteDynamicsWorld> first;
  if (kind == "second") first = makeWorld("plain", first_parts);
  std::unique_ptr<btDiscreteDynamicsWorld> world = makeWorld(kind, parts);
  std::uint64_t state = 0xcbf29ce484222325u;
  {
    Scene scene(*world);
    if (kind == "in_step") world->setInternalTickCallback(removeInStep, &scene, true);
    if (kind != "late") scene.addCubes();
    for (int step = 0; step < steps; ++step) {
      if (kind == "late" && step == 10) scene.addCubes();
      if (kind == "callback" && step == 10)
        world->setInternalTickCallback(countSubSteps, nullptr, true);
      if (kind == "removed" && step == 30) scene.removeFirstCube();
      if (kind == "removed" && step == 40) scene.putFirstCubeBack();
      world->stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
      scene.hash(state);
      const timespec pause{0, 1000000000 / 60};
      if (is_realtime) nanosleep(&pause, nullptr);
    }
    if (kind == "callback") state ^= static_cast<std::uint64_t>(seen_sub_steps);
    print(state, scene.firstCube());
    if (kind == "leaked") std::exit(0);  // exits without clean-up
    if (kind == "world_first") {
      world.reset();
      scene.forgetWorld();
    }
  }
  world.reset();
}

}  // namespace
}  // namespace tandem::test

#ifdef TANDEM_HOST_IS_PLUGIN
extern "C" [[gnu::visibility("default")]] int runHost(int argc, char** argv) {
#else
int main(int argc, char** argv) {
#endif
  int steps = 60;
  bool is_realtime = false;
  std::string kind = "plain";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--steps" && i + 1 < argc) steps = std::atoi(argv[++i]);
    if (argument == "--world" && i + 1 < argc) kind = argv[++i];
    if (argument == "--realtime") is_realtime = true;
  }
  if (kind != "none") tandem::test::run(kind, steps, is_realtime);
  return 0;
}
