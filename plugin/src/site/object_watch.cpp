#include "site/object_watch.h"

#include <algorithm>
#include <utility>

#include "tandem/bullet_bridge/shapes.h"

#include "bullet_bridge/src/bodies/body_look.h"
#include "bullet_bridge/src/bodies/mass_restore.h"
#include "bullet_bridge/src/world/world_access.h"
#include "site/teleport.h"

namespace tandem {

/// True if the island may hold the body. It must be in its world.
bool ObjectWatch::mayHold(const SharedObject& object) const noexcept {
  return isMovedByForces(*object.rigid) && isFinite(readState(*object.rigid)) &&
         !surroundings_.isDragged(*object.rigid);
}

bool ObjectWatch::findChanged() {
  bool is_missing = false;
  for (SharedObject& object : bodies_.objects) {
    if (!object.body.is_held || object.body.is_leaving) {
      is_missing |= object.rigid && !object.is_there;
      continue;
    }
    object.is_there = object.bullet->isInWorld();
    is_missing |= !object.is_there;
    if (!object.is_there || !object.bullet->isAsHeld() || !mayHold(object)) leave(object);
  }
  for (Peer& peer : peers_) {
    if (!peer.proxy.sphere) continue;
    SiteBody& body = peer.proxy.body;
    const bool is_alive = peer.proxy.sphere->isAlive();
    if (!is_alive) surroundings_.forgetExcluded(std::exchange(peer.proxy.address, nullptr));
    // The island moves it on, without a body in Bullet.
    body.is_leaving = !is_alive || !body.bullet->isInWorld();
    is_missing |= body.is_leaving;
  }
  log_.setMissing(is_missing);
  return are_leaving_;
}

void ObjectWatch::leaveAll() {
  for (SharedObject& object : bodies_.objects)
    if (object.body.is_held && !object.body.is_leaving) leave(object);
}

void ObjectWatch::leaveOne(SharedObject& object) {
  if (!object.body.is_held || object.body.is_leaving) return;
  object.is_there = object.bullet->isInWorld();
  leave(object);
}

void ObjectWatch::forget(SharedObject& object) noexcept {
  surroundings_.release(std::move(object.bullet));
  object.rigid = nullptr;
  object.is_there = object.is_sent = false;
  --left_;
}

void ObjectWatch::expect(SharedObject& object, btRigidBody& rigid) noexcept {
  object.rigid = &rigid;
  object.is_there = true;
  ++left_;
}

void ObjectWatch::leave(SharedObject& object) {
  object.body.is_leaving = true;
  object.led = {};
  object.was_put = false;
  object.body.step.forgetReaction();
  are_leaving_ = true;
  ++left_;
  ++log_.counters.objects_left;
  surroundings_.releaseBody(object.body.index, *object.rigid, object.is_there);
}

void ObjectWatch::takeLeaving() noexcept {
  if (!are_leaving_) return;
  for (SharedObject& object : bodies_.objects) {
    SiteBody& body = object.body;
    if (!body.is_leaving || !body.is_held) continue;
    const RigidState last = island_.state(body.index);
    hand_.energy().countNeighbour(island_.body(body.index), last, -1.0);
    object.owed = forces_.computeOwed(body);
    surroundings_.joints().drop(body.index);
    island_.clear(body.index);
    island_.setState(body.index, last);
    body.is_held = object.awaits_put = false;
    object.is_sent = object.is_there;
  }
}

void ObjectWatch::giveBack(bool is_between_steps) {
  if (!are_leaving_) return;
  are_leaving_ = false;
  for (SharedObject& object : bodies_.objects) {
    if (!object.body.is_leaving || object.body.is_held) continue;
    object.body.is_leaving = false;
    object.body.bullet = nullptr;
    // A missing body may come back; its mass is restored then.
    if (!object.is_there) continue;
    object.bullet->addMomentum(object.owed.linear_W, object.owed.angular_W);
    const WeightInStep weight(*object.rigid);
    object.bullet.reset();
    if (!is_between_steps) weight.follow(*object.rigid);
  }
}

void ObjectWatch::explain(std::vector<std::string>& lines) const {
  for (const SharedObject& object : bodies_.objects) {
    if (!object.rigid) continue;
    const std::string name = "object " + std::to_string(object.id);
    if (object.is_there && (object.body.is_held || object.is_new)) {
      if (surroundings_.leavesJointsOf(*object.rigid))
        lines.push_back(
            name +
            " hangs on joints that stay Bullet's, at the host's rate: share no body of a "
            "chain with a joint of your own type or a body that cannot be held, or raise "
            "max_neighbours");
      continue;
    }
    if (!object.is_there) {
      lines.push_back(name +
                      " is not in the Bullet world: put its body back, or share another for it");
    } else if (!mayHold(object)) {
      lines.push_back(
          name +
          " is left to Bullet: its body is static, kinematic, without contact response, "
          "switched off or dragged by a joint whose frames move; peers follow it");
    } else if (!findShareableShape(*object.rigid)) {
      lines.push_back(name + " is left to Bullet: its shape cannot be shared; peers follow it");
    }
  }
}

bool ObjectWatch::findReturned() {
  if (left_ == 0) return false;
  bool is_any_new = false;
  for (SharedObject& object : bodies_.objects) {
    if (!object.rigid || object.body.is_held || object.body.is_leaving || object.is_new) continue;
    int hint = -1;
    object.is_there = findRigidBody(world_, object.rigid, hint) != nullptr;
    if (!object.is_there) continue;
    object.bullet.reset();
    object.lookAtLed(readState(*object.rigid), object.rigid->isKinematicObject(),
                     object.rigid->isStaticObject() || !object.rigid->isActive());
    if (!mayHold(object) || surroundings_.isNeighbour(*object.rigid)) continue;
    object.is_new = hold(object);
    is_any_new |= object.is_new;
  }
  return is_any_new;
}

/// False if the body has a shape now that cannot be shared.
bool ObjectWatch::hold(SharedObject& object) {
  const std::optional<Shape> shape = findShareableShape(*object.rigid);
  if (!shape) return false;
  object.body.step = {};
  const WeightInStep weight(*object.rigid);
  object.hold(world_, *shape);
  weight.follow(*object.rigid);
  object.body.load = {};
  object.body.load.makeRoom();
  object.body.step.f_gravity_W = object.bullet->gravityForce();
  surroundings_.holdBody(object.body.index, *object.rigid, object.settings.start);
  return true;
}

/// An object that Bullet has, or had, is elsewhere now if it cannot have moved there by itself.
void ObjectWatch::notePlace(SharedObject& object, const RigidState& now, double dt) noexcept {
  const RigidState& last = island_.state(object.body.index);
  const double by_itself = dt * std::max(now.v_W.norm(), last.v_W.norm());
  const double way = std::max(0.0, (now.p_W - last.p_W).norm() - by_itself);
  const double rate = std::max(now.w_W.norm(), last.w_W.norm());
  const Quat turn = dt * rate < 0.1 ? Quat(now.q_WB * last.q_WB.conjugate()) : Quat::Identity();
  if (isTeleport(way, turn, object.bounding_radius)) peers_.beginEpoch(object);
}

void ObjectWatch::take(double dt) noexcept {
  takeLeaving();
  if (left_ == 0) return;
  for (SharedObject& object : bodies_.objects) {
    SiteBody& body = object.body;
    if (object.is_new) {
      object.is_new = false;
      object.is_sent = true;
      --left_;
      notePlace(object, object.settings.start, dt);
      body.is_held = true;
      body.seen = object.settings.start;
      island_.fill(body.index, object.settings);
      forces_.setWeight(body, body.step.f_gravity_W);
      timeline_.enter(body.index, object.settings.start);
      surroundings_.addNewcomer(body.index);
      peers_.awaitNews(object);
    } else if (!body.is_held) {
      object.is_sent = object.is_there;
      if (!object.is_there) continue;
      notePlace(object, object.seen, dt);
      island_.setState(body.index, object.seen);
      body.seen = object.seen;
    }
  }
}

}  // namespace tandem
