#include <climits>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tandem/plugin/site.h"

#include "bullet_bridge/src/world/world_access.h"
#include "c/values.h"
#include "c/world.h"

namespace tandem::c_door {

World::World()
    : own_(std::make_unique<OwnWorld>()), bullet_(&own_->world()), abi_(bulletAbiOfThisCode()) {}

World::World(btDiscreteDynamicsWorld& host, BulletAbi abi) : bullet_(&host), abi_(abi) {
  checkBulletAbi(abi);
}

btDiscreteDynamicsWorld& World::bullet() const {
  if (was_gone_ || (site_ && site_->isWorldGone()))
    throw Refusal(TANDEM_WORLD_GONE,
                  "the host has destroyed this world; destroy the site and this handle, and attach "
                  "to another world");
  return *bullet_;
}

void World::watch(const Site* site) noexcept {
  was_gone_ = was_gone_ || (site_ && site_->isWorldGone());
  site_ = site;
}

OwnWorld& World::own(const char* what) const {
  if (!own_)
    throw std::invalid_argument(std::string("the world is the host's: ") + what +
                                " is for worlds of tandem_world_create(); the host does it itself");
  return *own_;
}

TandemBody World::number(btRigidBody& rigid) {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (bodies_[i] && bodies_[i]->rigid == &rigid) return static_cast<TandemBody>(i + 1);
  if (bodies_.size() >= UINT32_MAX)
    throw Error("a world numbers 2^32 - 1 bodies; make another one");
  bodies_.push_back(std::make_unique<WorldBody>());
  bodies_.back()->rigid = &rigid;
  return static_cast<TandemBody>(bodies_.size());
}

TandemBody World::find(const btRigidBody* rigid) const noexcept {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (bodies_[i] && bodies_[i]->rigid == rigid) return static_cast<TandemBody>(i + 1);
  return TANDEM_NO_BODY;
}

void World::reserveNumber() { bodies_.reserve(bodies_.size() + 1); }

void World::forget(TandemBody body) noexcept { bodies_[body - 1].reset(); }

WorldBody& World::body(TandemBody body) const {
  if (body == TANDEM_NO_BODY) throw std::invalid_argument("the body is TANDEM_NO_BODY");
  if (body > bodies_.size() || !bodies_[body - 1])
    throw std::invalid_argument("body " + std::to_string(body) +
                                " is none of this world; add it, or find it");
  WorldBody& found = *bodies_[body - 1];
  if (!findRigidBody(bullet(), found.rigid, found.place))
    throw Error("body " + std::to_string(body) +
                " was taken out of the world by the host; put it back, or forget it");
  return found;
}

}  // namespace tandem::c_door

using namespace tandem;          // NOLINT: the functions of the header are in no namespace
using namespace tandem::c_door;  // NOLINT

extern "C" {

TandemResult tandem_world_create(TandemWorld** world) {
  return guarded([&] {
    auto& out = checkPointer(world, "world");
    out = Shells<TandemWorld>::all().wrap(std::make_unique<World>());
  });
}

TandemResult tandem_world_attach(void* discrete_dynamics_world, size_t scalar_bytes,
                                 int bullet_version, TandemWorld** world) {
  return guarded([&] {
    auto& out = checkPointer(world, "world");
    checkPointer(static_cast<char*>(discrete_dynamics_world), "discrete_dynamics_world");
    auto& host = *static_cast<btDiscreteDynamicsWorld*>(discrete_dynamics_world);
    out = Shells<TandemWorld>::all().wrap(
        std::make_unique<World>(host, BulletAbi{scalar_bytes, bullet_version}));
  });
}

TandemResult tandem_world_destroy(TandemWorld* world) {
  return guarded([&] { Shells<TandemWorld>::all().destroy(world); });
}

TandemResult tandem_world_set_gravity(TandemWorld* world, const double gravity[3]) {
  return guarded([&] {
    const World& in = open(world);
    setWorldGravity(in.bullet(), readVec3("gravity", gravity));
  });
}

TandemResult tandem_world_step(TandemWorld* world, double dt, int max_substeps, double fixed_step) {
  return guarded([&] {
    const World& in = open(world);
    (void)in.own("tandem_world_step()");
    if (in.guests.is_open)
      throw std::invalid_argument(
          "a step of guests has begun, and is the world's step; call tandem_world_end_step() "
          "first");
    requireNotNegative("dt", dt);
    if (max_substeps < 0)
      refuseValue("max_substeps", max_substeps, "0 or more; 0 for one step of dt");
    if (max_substeps > 0) requirePositive("fixed_step", fixed_step);
    stepWorld(in.bullet(), dt, max_substeps, fixed_step);
  });
}

}  // extern "C"
