// Functions of btDiscreteDynamicsWorld that replace Bullet's in a process with LD_PRELOAD. Each one
// finds and calls the original, and informs the adaptor if the world is shared.
//
//   host, its plugins, Bullet's virtual functions ──► here ──► the process's own libBulletDynamics
//                                                      └─────► adaptor, if the world is shared
//
// No Bullet header is used, because it fixes one width and this library serves both. `this` is the
// first argument, as in the C++ ABI of Linux.

#include "host_bullet.h"
#include "shared_world.h"

#define WORLD "_ZN23btDiscreteDynamicsWorld"
#define MADE_OF \
  "EP12btDispatcherP21btBroadphaseInterfaceP18btConstraintSolverP24btCollisionConfiguration"
#define SHOWN_AS(symbol) __asm__(symbol) __attribute__((visibility("default"), used))
#define CALLER __builtin_return_address(0)

namespace tandem::preload {

// C1, D1: a complete object; C2, D2: the base of another class; D0: deleting.
void constructComplete(void* world, void* dispatcher, void* pairs, void* solver, void* settings)
    SHOWN_AS(WORLD "C1" MADE_OF);
void constructBase(void* world, void* dispatcher, void* pairs, void* solver, void* settings)
    SHOWN_AS(WORLD "C2" MADE_OF);
void destroyComplete(void* world) SHOWN_AS(WORLD "D1Ev");
void destroyBase(void* world) SHOWN_AS(WORLD "D2Ev");
void destroyDeleting(void* world) SHOWN_AS(WORLD "D0Ev");
int stepFloat(void* world, float dt, int max_sub_steps, float fixed_step)
    SHOWN_AS(WORLD "14stepSimulationEfif");
int stepDouble(void* world, double dt, int max_sub_steps, double fixed_step)
    SHOWN_AS(WORLD "14stepSimulationEdid");
void removeBody(void* world, void* body) SHOWN_AS(WORLD "15removeRigidBodyEP11btRigidBody");
void removeObject(void* world, void* object)
    SHOWN_AS(WORLD "21removeCollisionObjectEP17btCollisionObject");

namespace {

void construct(Construct HostBullet::*constructor, const void* caller, void* world,
               void* dispatcher, void* pairs, void* solver, void* settings) {
  const HostBullet& bullet = findHostBullet(caller);
  (bullet.*constructor)(world, dispatcher, pairs, solver, settings);
  rememberWorld(world, bullet);
  offerWorld(world, bullet);
}

void destroy(Destroy HostBullet::*destructor, const void* caller, void* world) {
  const HostBullet& bullet = bulletOf(world, caller);
  endWorld(world, bullet);
  // The deleting destructor calls the complete one, which comes here again.
  if (destructor != &HostBullet::destroy_deleting) forgetWorld(world);
  (bullet.*destructor)(world);
}

template <typename Scalar, typename Step>
int step(Step step_host, void* world, Scalar dt, int max_sub_steps, Scalar fixed_step) {
  const TandemPreloadDoor* adaptor = adaptorOf(world);
  if (!adaptor) return step_host(world, dt, max_sub_steps, fixed_step);
  adaptor->beforeStep();
  const int sub_steps = step_host(world, dt, max_sub_steps, fixed_step);
  adaptor->afterStep(static_cast<double>(dt), max_sub_steps, static_cast<double>(fixed_step),
                     sub_steps);
  return sub_steps;
}

void remove(Remove HostBullet::*remover, const void* caller, void* world, void* object) {
  if (const TandemPreloadDoor* adaptor = adaptorOf(world)) adaptor->objectLeaves(object);
  (bulletOf(world, caller).*remover)(world, object);
}

[[gnu::constructor]] void begin() { lookAtProgram(); }
[[gnu::destructor]] void end() { sayIfNothingCame(); }

}  // namespace

void constructComplete(void* world, void* dispatcher, void* pairs, void* solver, void* settings) {
  construct(&HostBullet::construct_complete, CALLER, world, dispatcher, pairs, solver, settings);
}
void constructBase(void* world, void* dispatcher, void* pairs, void* solver, void* settings) {
  construct(&HostBullet::construct_base, CALLER, world, dispatcher, pairs, solver, settings);
}

void destroyComplete(void* world) { destroy(&HostBullet::destroy_complete, CALLER, world); }
void destroyBase(void* world) { destroy(&HostBullet::destroy_base, CALLER, world); }
void destroyDeleting(void* world) { destroy(&HostBullet::destroy_deleting, CALLER, world); }

int stepFloat(void* world, float dt, int max_sub_steps, float fixed_step) {
  return step(bulletOf(world, CALLER).step_float, world, dt, max_sub_steps, fixed_step);
}
int stepDouble(void* world, double dt, int max_sub_steps, double fixed_step) {
  return step(bulletOf(world, CALLER).step_double, world, dt, max_sub_steps, fixed_step);
}

void removeBody(void* world, void* body) { remove(&HostBullet::remove_body, CALLER, world, body); }
void removeObject(void* world, void* object) {
  remove(&HostBullet::remove_object, CALLER, world, object);
}

}  // namespace tandem::preload
