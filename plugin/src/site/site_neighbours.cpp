#include <algorithm>
#include <cmath>

#include "tandem/bullet_bridge/shapes.h"

#include "site/site_impl.h"

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
  leaving.clear();
  for (Neighbour& neighbour : neighbours)
    if (neighbour.rigid && !neighbour.isInWorld()) leaving.push_back(&neighbour);
  demoteLeaving();
}

/// Not the island's before takeNewcomers().
void Site::Impl::promote(btRigidBody& rigid, Neighbour& neighbour) {
  ++counters.promoted;
  const BodyIndex index = neighbour.body.index;
  neighbour.rigid = &rigid;
  neighbour.shape = rigid.getCollisionShape();
  neighbour.is_new = true;
  neighbour.settings = {};
  neighbour.settings.is_rigid = true;
  const std::optional<Shape> shape = convertShape(*rigid.getCollisionShape());
  if (shape) neighbour.settings.shape = *shape;
  neighbour.settings.touches_spheres = shape.has_value();
  if (rigid.isKinematicObject()) {
    neighbour.driven = std::make_unique<DrivenBody>(host_world.world(), rigid, host_time);
    neighbour.settings.motion = neighbour.driven->motion();
  } else {
    hold(rigid, neighbour);
  }
  obstacles.addBody(index, rigid);
  for (Remote& remote : remotes)
    if (remote.proxy) filterNativeContact(host_world.world(), remote.proxy->rigid(), rigid, true);
}

void Site::Impl::hold(btRigidBody& rigid, Neighbour& neighbour) {
  neighbour.bullet = std::make_unique<HapticBody>(host_world.world(), rigid, 1.0, Sleep::kAsHost);
  const HapticBody& bullet = *neighbour.bullet;
  neighbour.linear_damping = bullet.linearDamping();
  neighbour.angular_damping = bullet.angularDamping();

  IslandBody& own = neighbour.settings;
  own.mass = bullet.mass();
  own.inertia_B = bullet.inertia();
  own.damping = own.mass * computeDecay(bullet.linearDamping());
  own.angular_damping = computeDecay(bullet.angularDamping());
  own.start = bullet.state();
  SiteBody& body = neighbour.body;
  body.bullet = neighbour.bullet.get();
  body.f_gravity_W = bullet.gravityForce();
  body.seen = own.start;
}

/// The island gets those that were promoted.
void Site::Impl::takeNewcomers() noexcept {
  for (Neighbour& neighbour : neighbours) {
    if (!neighbour.is_new) continue;
    neighbour.is_new = false;
    neighbour.is_held = neighbour.bullet != nullptr;
    const BodyIndex index = neighbour.body.index;
    if (neighbour.driven) neighbour.settings.start = neighbour.driven->at(island_time);
    island.fill(index, neighbour.settings);
    if (neighbour.bullet) {
      setWorldWrench(index, neighbour.body.f_gravity_W, Vec3::Zero());
      newcomers.push_back(index);
    }
    tick_start_states[index] = neighbour.settings.start;
  }
  obstacles.commit();
  mirrorIsland();
}

/// Those in `leaving` are the host's again.
void Site::Impl::demoteLeaving() {
  if (leaving.empty()) return;
  may_skip = false;
  for (Neighbour* neighbour : leaving) unfilter(*neighbour);
  desk.run([&] {
    obstacles.commit();
    for (Neighbour* neighbour : leaving) takeOut(*neighbour);
    mirrorIsland();
  });
  for (Neighbour* neighbour : leaving) giveBack(*neighbour);
  leaving.clear();
}

/// Native contact is the host's again.
void Site::Impl::unfilter(Neighbour& neighbour) {
  const bool is_present = neighbour.isInWorld();
  for (Remote& remote : remotes) {
    if (!remote.proxy || !remote.proxy->isAlive()) continue;
    btRigidBody& proxy = remote.proxy->rigid();
    if (is_present) {
      filterNativeContact(host_world.world(), proxy, *neighbour.rigid, false);
    } else {
      proxy.setIgnoreCollisionCheck(neighbour.rigid, false);
    }
  }
  obstacles.removeBody(neighbour.body.index);
}

void Site::Impl::takeOut(Neighbour& neighbour) noexcept {
  const BodyIndex index = neighbour.body.index;
  std::erase(newcomers, index);
  if (neighbour.is_held) countNeighbour(neighbour, -1.0);
  if (neighbour.is_held) neighbour.owed = computeOwed(neighbour.body);
  island.clear(index);
  neighbour.is_held = false;
}

void Site::Impl::giveBack(Neighbour& neighbour) {
  ++counters.demoted;
  const BodyIndex index = neighbour.body.index;
  if (neighbour.bullet && neighbour.isInWorld())
    neighbour.bullet->applyWrench(neighbour.owed.impulse_W, neighbour.owed.angular_impulse_W, 1.0);
  neighbour.bullet.reset();
  neighbour.driven.reset();
  neighbour.rigid = nullptr;
  neighbour.body = {};
  neighbour.body.index = index;
  neighbour.body.given.reserve(kGivenImpulses);
}

/// Momentum that reached the island later than the host's time, and the host's own force that has
/// not reached it yet.
GivenImpulse Site::Impl::computeOwed(const SiteBody& body) noexcept {
  settleHostForces();
  const double ahead = std::max(0.0, island_time - host_time);
  GivenImpulse owed;
  owed.impulse_W = body.owed_W + ahead * body.f_host_W;
  owed.angular_impulse_W = body.owed_angular_W + ahead * body.t_host_W;
  for (const GivenImpulse& given : body.given) {
    if (given.time <= host_time) continue;
    owed.impulse_W += given.impulse_W;
    owed.angular_impulse_W += given.angular_impulse_W;
  }
  return owed;
}

void Site::Impl::demoteAll() {
  leaving.clear();
  for (Neighbour& neighbour : neighbours)
    if (neighbour.rigid) leaving.push_back(&neighbour);
  demoteLeaving();
}

/// Where the host's step that ends at `step_end` has taken, or will take, kinematic bodies.
void Site::Impl::lookAtDriven(double step_end) noexcept {
  for (Neighbour& neighbour : neighbours)
    if (neighbour.driven) neighbour.driven->look(step_end);
}

/// Kinematic bodies go where the host's latest pose and velocity lead. The step that they were seen
/// in is still to come for the island if it ticks inside of it: then they are there in time. Else
/// it is over, what was guessed was wrong by a little, and is mended slowly.
void Site::Impl::steerDriven() noexcept {
  for (Neighbour& neighbour : neighbours) {
    if (!neighbour.driven) continue;
    DrivenBody& driven = *neighbour.driven;
    const BodyIndex index = neighbour.body.index;
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
  const double damping = own.mass * computeDecay(neighbour.linear_damping);
  const double angular_damping = computeDecay(neighbour.angular_damping);
  if (damping == own.damping && angular_damping == own.angular_damping) return;
  own.damping = damping;
  own.angular_damping = angular_damping;
  const SiteBody& body = neighbour.body;
  own.start = island.state(body.index);
  island.fill(body.index, own);
  setWorldWrench(body.index, body.f_gravity_W + body.f_host_W, body.t_host_W);
}

}  // namespace tandem
