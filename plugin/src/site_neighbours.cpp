#include <algorithm>
#include <cmath>

#include "tandem/bullet_bridge/shapes.h"

#include "site_impl.h"

// Bodies of the host's world that the island holds for a while.
//
//   dynamic    the island moves it; the host's body follows by hand-off
//   kinematic  the host moves it; the island's body goes where it is going
//
// They come in the host's state at the host's time, and what the host is owed when one goes back -
// momentum that its state there does not have yet - is paid.

namespace tandem {
namespace {

/// In which a kinematic body gets back to the host's way that it was guessed off [s]. Longer leaves
/// it off for longer; shorter hits what it touches harder.
constexpr double kMendingTime = 0.1;

/// Rate of decay of a velocity that Bullet multiplies by (1 - d)^dt [1/s].
double computeDecay(double damping) {
  constexpr double kFastest = 1e3;
  return damping < 1.0 ? std::min(-std::log1p(-damping), kFastest) : kFastest;
}

}  // namespace

void Site::Impl::dropMissingNeighbours() {
  for (Neighbour& neighbour : neighbours)
    if ((neighbour.bullet && !neighbour.bullet->isInWorld()) ||
        (neighbour.driven && !neighbour.driven->isInWorld()))
      demote(neighbour);
}

void Site::Impl::promote(btRigidBody& rigid, Neighbour& neighbour) {
  ++counters.promoted;
  const BodyIndex index = neighbour.body.index;
  neighbour.rigid = &rigid;
  neighbour.shape = rigid.getCollisionShape();
  neighbour.body = {};
  neighbour.body.index = index;
  neighbour.settings = {};
  neighbour.settings.is_rigid = true;
  const std::optional<Shape> shape = convertShape(*rigid.getCollisionShape());
  if (shape) neighbour.settings.shape = *shape;
  neighbour.settings.touches_spheres = shape.has_value();
  if (rigid.isKinematicObject()) {
    drive(rigid, neighbour);
  } else {
    hold(rigid, neighbour);
  }
  obstacles.addBody(index, rigid);
  for (Remote& remote : remotes)
    if (remote.proxy) filterNativeContact(host_world.world(), remote.proxy->rigid(), rigid, true);
}

void Site::Impl::hold(btRigidBody& rigid, Neighbour& neighbour) {
  SiteBody& body = neighbour.body;
  neighbour.bullet = std::make_unique<HapticBody>(host_world.world(), rigid, 1.0, Sleep::kAsHost);
  body.bullet = neighbour.bullet.get();
  body.f_gravity_W = neighbour.bullet->gravityForce();

  IslandBody& own = neighbour.settings;
  own.mass = neighbour.bullet->mass();
  own.inertia_B = neighbour.bullet->inertia();
  own.damping = own.mass * computeDecay(neighbour.bullet->linearDamping());
  own.angular_damping = computeDecay(neighbour.bullet->angularDamping());
  own.start = neighbour.bullet->state();
  island.fill(body.index, own);
  setWorldWrench(body.index, body.f_gravity_W, Vec3::Zero());
  tick_start_states[body.index] = own.start;
  newcomers.push_back(body.index);
}

void Site::Impl::drive(btRigidBody& rigid, Neighbour& neighbour) {
  neighbour.driven = std::make_unique<DrivenBody>(host_world.world(), rigid, host_time);
  neighbour.settings.motion = neighbour.driven->motion();
  neighbour.settings.start = neighbour.driven->at(island_time);
  island.fill(neighbour.body.index, neighbour.settings);
  tick_start_states[neighbour.body.index] = neighbour.settings.start;
}

void Site::Impl::demote(Neighbour& neighbour) {
  ++counters.demoted;
  const BodyIndex index = neighbour.body.index;
  const bool is_present = neighbour.bullet ? neighbour.bullet->isInWorld()  //
                                           : neighbour.driven->isInWorld();
  for (Remote& remote : remotes) {
    if (!remote.proxy) continue;
    btRigidBody& proxy = remote.proxy->rigid();
    if (is_present) {
      filterNativeContact(host_world.world(), proxy, *neighbour.rigid, false);
    } else {
      proxy.setIgnoreCollisionCheck(neighbour.rigid, false);
    }
  }
  obstacles.removeBody(index);
  std::erase(newcomers, index);
  if (neighbour.bullet) countNeighbour(neighbour, -1.0);
  if (neighbour.bullet && is_present) payOff(neighbour);
  island.clear(index);
  neighbour.bullet.reset();
  neighbour.driven.reset();
  neighbour.body = {};
  neighbour.body.index = index;
  neighbour.rigid = nullptr;
}

/// Momentum that reached the island later than the host's time, and the host's own force that has
/// not reached it yet.
void Site::Impl::payOff(Neighbour& neighbour) {
  settleHostForces();
  const SiteBody& body = neighbour.body;
  const double ahead = std::max(0.0, island_time - host_time);
  Vec3 impulse_W = body.owed_W + ahead * body.f_host_W;
  Vec3 angular_impulse_W = body.owed_angular_W + ahead * body.t_host_W;
  for (const GivenImpulse& given : body.given) {
    if (given.time <= host_time) continue;
    impulse_W += given.impulse_W;
    angular_impulse_W += given.angular_impulse_W;
  }
  neighbour.bullet->applyWrench(impulse_W, angular_impulse_W, 1.0);
}

void Site::Impl::demoteAll() {
  for (Neighbour& neighbour : neighbours)
    if (neighbour.rigid) demote(neighbour);
}

/// Kinematic bodies go where the host's latest pose and velocity lead. The step that ends at
/// `step_end` is still to come for the island if it ticks inside of it: then they are there in
/// time. Else it is over, what was guessed was wrong by a little, and is mended slowly.
void Site::Impl::steerDriven(double step_end) noexcept {
  for (Neighbour& neighbour : neighbours) {
    if (!neighbour.driven) continue;
    DrivenBody& driven = *neighbour.driven;
    const BodyIndex index = neighbour.body.index;
    driven.look(step_end);
    const double within = settings.tick_source == TickSource::kHostStep
                              ? driven.seenAt() - island_time
                              : kMendingTime;
    const RigidState state = driven.steer(island.state(index), island_time, within);
    if (driven.motion() != neighbour.settings.motion) {
      neighbour.settings.motion = driven.motion();
      neighbour.settings.start = state;
      island.fill(index, neighbour.settings);
    }
    island.setState(index, state);
    if (state.v_W != Vec3::Zero() || state.w_W != Vec3::Zero()) passivity.refill();
  }
}

/// The host may change a body's damping while we hold it.
void Site::Impl::followDamping(Neighbour& neighbour) noexcept {
  IslandBody& own = neighbour.settings;
  const double damping = own.mass * computeDecay(neighbour.bullet->linearDamping());
  const double angular_damping = computeDecay(neighbour.bullet->angularDamping());
  if (damping == own.damping && angular_damping == own.angular_damping) return;
  own.damping = damping;
  own.angular_damping = angular_damping;
  const SiteBody& body = neighbour.body;
  own.start = island.state(body.index);
  island.fill(body.index, own);
  setWorldWrench(body.index, body.f_gravity_W + body.f_host_W, body.t_host_W);
}

}  // namespace tandem
