#include <stdexcept>
#include <string>

#include "bullet_bridge/src/world/world_access.h"
#include "c/values.h"
#include "c/world.h"

namespace tandem::c_door {
namespace {

void checkOnce(World& in, std::size_t count, const TandemBody* bodies) {
  ++in.guests.lists;
  for (std::size_t i = 0; i < count; ++i) {
    WorldBody& body = in.body(bodies[i]);
    if (body.seen == in.guests.lists)
      throw std::invalid_argument("body " + std::to_string(bodies[i]) +
                                  " is in `bodies` twice; name each once");
    body.seen = in.guests.lists;
  }
}

/// Checks everything before anything is changed.
void checkBegin(World& in, double dt, std::size_t count, const TandemBody* bodies,
                const TandemState* now, const TandemState* handoff) {
  (void)in.own("tandem_world_begin_step()");
  if (in.guests.is_open)
    throw std::invalid_argument(
        "a step of guests has begun already; call tandem_world_end_step() first");
  requirePositive("dt", dt);
  if (count == 0) return;
  checkPointer(bodies, "bodies");
  checkPointer(now, "now");
  checkPointer(handoff, "handoff");
  for (std::size_t i = 0; i < count; ++i) {
    if (!isDynamic(*in.body(bodies[i]).rigid))
      throw std::invalid_argument("body " + std::to_string(bodies[i]) +
                                  " is static, so no guest; move it by tandem_world_set_state()");
    (void)fromC({"now", static_cast<std::ptrdiff_t>(i)}, now[i]);
  }
  checkOnce(in, count, bodies);
}

void begin(World& in, double dt, const Vec3& gravity_W, std::size_t count, const TandemBody* bodies,
           const TandemState* now, TandemState* handoff) {
  ++in.guests.number;
  for (std::size_t i = 0; i < count; ++i) {
    WorldBody& body = in.body(bodies[i]);
    if (!body.guest) body.guest.emplace(in.bullet(), *body.rigid);
    body.step = in.guests.number;
    body.guest->takeHostChanges(fromC("now", now[i]));
  }
  stepWorld(in.bullet(), dt, 0, dt);
  for (std::size_t i = 0; i < count; ++i)
    handoff[i] = toC(in.body(bodies[i]).guest->handOff(dt, gravity_W));
  in.guests.is_open = true;
  in.guests.count = count;
}

/// Checks that a step ends with the bodies that it began with; their order is free.
void checkEnd(World& in, std::size_t count, const TandemBody* bodies, const TandemState* now,
              const TandemState* after) {
  if (!in.guests.is_open)
    throw std::invalid_argument(
        "no step of guests has begun; call tandem_world_begin_step() first");
  if (count != in.guests.count)
    refuseValue("count", static_cast<double>(count), "as in tandem_world_begin_step()");
  if (count == 0) return;
  checkPointer(bodies, "bodies");
  checkPointer(now, "now");
  checkPointer(after, "after");
  for (std::size_t i = 0; i < count; ++i) {
    if (in.body(bodies[i]).step != in.guests.number)
      throw std::invalid_argument("body " + std::to_string(bodies[i]) +
                                  " was not in tandem_world_begin_step(); name the same bodies");
    (void)fromC({"now", static_cast<std::ptrdiff_t>(i)}, now[i]);
  }
  checkOnce(in, count, bodies);
}

}  // namespace
}  // namespace tandem::c_door

using namespace tandem;          // NOLINT: the functions of the header are in no namespace
using namespace tandem::c_door;  // NOLINT

extern "C" {

TandemResult tandem_world_begin_step(TandemWorld* world, double dt, const double host_gravity[3],
                                     size_t count, const TandemBody* bodies, const TandemState* now,
                                     TandemState* handoff) {
  return guarded([&] {
    World& in = open(world);
    checkBegin(in, dt, count, bodies, now, handoff);
    const Vec3 gravity_W = readVec3OrZero("host_gravity", host_gravity);
    begin(in, dt, gravity_W, count, bodies, now, handoff);
  });
}

TandemResult tandem_world_end_step(TandemWorld* world, size_t count, const TandemBody* bodies,
                                   const TandemState* now, TandemState* after) {
  return guarded([&] {
    World& in = open(world);
    checkEnd(in, count, bodies, now, after);
    for (std::size_t i = 0; i < count; ++i)
      after[i] = toC(in.body(bodies[i]).guest->takeBack(fromC("now", now[i])));
    in.guests.is_open = false;
  });
}

}  // extern "C"
