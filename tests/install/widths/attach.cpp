// Attaches a site to a world of the width that this file is compiled for, and reports the result.
// This may be a module of another width than the program's, or a program linked to another width. A
// world made by the wrong Bullet may be larger than expected, so there is spare room.
#include <cstdio>
#include <new>

#include <btBulletDynamicsCommon.h>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

namespace {

template <class Made>
struct Roomy {
  alignas(64) unsigned char bytes[4 * sizeof(Made)];

  template <class... Arguments>
  Made* make(Arguments... arguments) {
    return new (bytes) Made(arguments...);
  }
};

Roomy<btDefaultCollisionConfiguration> configuration_room;
Roomy<btCollisionDispatcher> dispatcher_room;
Roomy<btDbvtBroadphase> broadphase_room;
Roomy<btSequentialImpulseConstraintSolver> solver_room;
Roomy<btDiscreteDynamicsWorld> world_room;

}  // namespace

extern "C" [[gnu::visibility("default")]] void attachSite(char* answer, int room) {
  auto* const configuration = configuration_room.make();
  btDiscreteDynamicsWorld* const world =
      world_room.make(dispatcher_room.make(configuration), broadphase_room.make(),
                      solver_room.make(), configuration);
  try {
    tandem::SimulatedDevice device({}, tandem::makeConstantHand({0, 0, 0}));
    const tandem::Site site({}, *world, device);
    std::snprintf(answer, static_cast<std::size_t>(room), "attached");
  } catch (const tandem::Error& error) {
    std::snprintf(answer, static_cast<std::size_t>(room), "refused: %s", error.what());
  }
}
