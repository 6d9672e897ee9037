#include <algorithm>
#include <cmath>
#include <limits>

#include "site/site_impl.h"

// The host's step, as the thread that steps the world has it. What touches the island is asked of
// whoever owns it (IslandDesk); what touches the host's world is done here:
//
//   pre-tick    look: what the host did to its bodies     ask: give it to the island, which moves
//   on
//               hand off where they are at the step's end
//   Bullet      steps
//   post-tick   take back what its solver did             ask: give that to the island
//               look around                               ask: take in what is near

namespace tandem {
namespace {

/// How far the host's clock, summed up in btScalar, may be off the ticks' before a state counts as
/// another one [s].
constexpr double kClockTolerance = 1e-9;

/// What is left of an account of momentum by rounding would keep bodies awake [N s, N m s]; so
/// would what Bullet's arithmetic adds to a hand-off.
constexpr double kNoMomentum = 1e-15;

Vec3 dropRounding(const Vec3& momentum) noexcept {
  return momentum.squaredNorm() < kNoMomentum * kNoMomentum ? Vec3(Vec3::Zero()) : momentum;
}
/// A host later than this, besides what it may, has dropped the time: its clock is set on [s].
constexpr double kLostTime = 0.5;

constexpr double kForEver = std::numeric_limits<double>::infinity();

/// A live host's clock is set on by what it was late at least in so long [s].
constexpr double kHostWatch = 1.0;

/// The lateness of the host's forces falls by this part of the host's time.
constexpr double kLatenessDecay = 0.02;

/// Cubic between two states, right to about w^4 h^4 / 384 of the motion; h apart [s].
RigidState interpolate(const RigidState& a, double a_time, const RigidState& b, double b_time,
                       double time) noexcept {
  const double h = b_time - a_time;
  if (!(h > 0.0)) return b;
  const double s = (time - a_time) / h, s2 = s * s, s3 = s2 * s;
  RigidState state;
  state.p_W = (2 * s3 - 3 * s2 + 1) * a.p_W + (s3 - 2 * s2 + s) * h * a.v_W +
              (3 * s2 - 2 * s3) * b.p_W + (s3 - s2) * h * b.v_W;
  state.v_W = (6 * s2 - 6 * s) / h * (a.p_W - b.p_W) + (3 * s2 - 4 * s + 1) * a.v_W +
              (3 * s2 - 2 * s) * b.v_W;
  state.q_WB = a.q_WB.slerp(s, b.q_WB);
  state.w_W = (1 - s) * a.w_W + s * b.w_W;
  return state;
}

/// Where a body was that goes steadily to `end` in dt.
RigidState computeStart(RigidState end, double dt) noexcept {
  end.p_W -= dt * end.v_W;
  return end;
}

}  // namespace

void Site::Impl::beforeHostStep(double dt) noexcept {
  ++counters.host_steps;
  if (isWaiting() || skipBeforeHostStep(dt)) return;
  dropMissingNeighbours();
  if (!allBodiesPresent()) {
    // The hand still gets its fading force.
    desk.run([&] {
      followHostClock(dt);
      if (settings.tick_source == TickSource::kHostStep) runTicksUntil(host_time + dt);
    });
    return;
  }
  if (native) {
    followHostClock(dt);
    beforeNativeStep(dt);
    return;
  }
  if (!isHandoff() && std::abs(dt - period()) > 1e-3 * period()) status_of_host |= kHostStepWrong;

  if (isHandoff()) lookAtBodies(dt);
  desk.run([&] {
    followHostClock(dt);
    const double end = host_time + dt;
    host_step = dt;
    if (island_time < end) handoff_due = end;
    if (isHandoff()) passHostChanges(dt);
    if (settings.tick_source == TickSource::kHostStep) {
      lookAtDriven(end);
      steerDriven();
      runTicksUntil(end);
    }
    if (isHandoff()) findEnds(end);
  });
  if (isHandoff()) {
    handOff(dt);
  } else {
    forEachBody([&](SiteBody& body) {
      if (island.isDynamic(body.index)) body.bullet->applyWrench(body.f_W, body.t_W, dt);
    });
  }
}

void Site::Impl::afterHostStep(double dt) noexcept {
  if (isWaiting()) return waitOn(dt);
  if (skipAfterHostStep(dt)) return;
  dropMissingNeighbours();
  if (!allBodiesPresent()) return desk.run([&] { host_time += dt; });
  if (native) {
    host_time += dt;
    afterNativeStep(dt);
    return;
  }
  if (isHandoff()) forEachBody([&](SiteBody& body) { takeBack(body); });
  const bool is_behind = settings.tick_source == TickSource::kCaller;
  if (is_behind) lookAtDriven(host_time + dt);
  desk.run([&] {
    host_time += dt;
    forEachBody([&](SiteBody& body) {
      if (isHandoff()) {
        receive(body);
      } else if (island.isDynamic(body.index)) {
        island.setState(body.index, body.bullet->state());
      } else {
        body.bullet->setState(island.state(body.index));
      }
    });
    announceNextEnd(dt);
    if (is_behind) steerDriven();
    if (!desk.isOpen()) makeRoomFor(dt);
    mirrorIsland();
  });
  if (isHandoff()) forEachBody([&](SiteBody& body) { parkIfItStood(body); });
  updateSurroundings(dt);
  ++counters.searches;
  fallQuiet();
}

/// What Bullet's solver did besides: contact with moving bodies that are not held.
void Site::Impl::takeBack(SiteBody& body) noexcept {
  HostChange change;
  body.was_parked = body.bullet->isParked();
  body.was_near_awake = body.was_parked && !body.bullet->isAsleep();
  if (!body.was_parked) {
    change = body.bullet->restore();
  } else if (body.bullet->wakeIfHit(change)) {
    noteWoken(body);
  }
  body.hit_W = dropRounding(change.impulse_W);
  body.angular_hit_W = dropRounding(change.angular_impulse_W);
}

void Site::Impl::receive(SiteBody& body) noexcept {
  if (!body.was_parked)
    std::erase_if(body.given, [&](const GivenImpulse& g) { return g.time <= host_time; });
  give(body, body.hit_W, body.angular_hit_W);
  body.may_park = mayPark(body);
  body.seen = body.end;
}

/// The island stops at the end of the next step for a moment, even inside a tick.
void Site::Impl::announceNextEnd(double dt) noexcept {
  handoff_due = host_time + dt;
  constexpr double kManySteps = 1000.0;
  if (island_time - handoff_due > kManySteps * dt)
    handoff_due += std::floor((island_time - handoff_due) / dt) * dt;
  while (handoff_due <= island_time)
    handoff_due = std::max(handoff_due + dt, std::nextafter(handoff_due, kForEver));
}

/// A host may be late and make up for it, step by step. One that has dropped time never will.
void Site::Impl::followHostClock(double dt) noexcept {
  const double late = island_time - (host_time + dt);
  if (desk.isOpen()) {
    followLiveHost(late, dt);
  } else if (late > kLostTime + settings.host_stall) {
    host_time += late;
    ++counters.host_clock_set;
  }
  if (settings.tick_source == TickSource::kHostStep) return;
  const double beyond_tick = std::max(0.0, island_time - (host_time + dt) - period());
  host_lateness = std::max(beyond_tick, host_lateness - kLatenessDecay * dt);
}

/// By a clock of its own a host is early or late for good. One that asks for what has not been yet
/// gets what is now, and its clock is set back. One that asks for what is not kept any more has
/// stood still: its clock is set on at once; and by the least that it was late all through a while,
/// as it is not going to make up for that.
void Site::Impl::followLiveHost(double late, double dt) noexcept {
  const double kept = static_cast<double>(snapshots.room() - 2) * dt;
  has_host_jumped = late > kept;
  if (late < 0.0 || has_host_jumped) host_time += late;
  least_late = has_host_jumped ? 0.0 : std::min(least_late, std::max(late, 0.0));
  watched_host += dt;
  const bool is_over = watched_host >= kHostWatch;
  const bool is_set_on = is_over && least_late > period();
  if (is_set_on) host_time += least_late;
  counters.host_clock_set += has_host_jumped || is_set_on;
  if (!is_over) return;
  least_late = std::numeric_limits<double>::infinity();
  watched_host = 0.0;
}

bool Site::Impl::allBodiesPresent() noexcept {
  bool present = !native || native->isPresent();
  forEachBody([&](SiteBody& body) { present &= body.bullet->isInWorld(); });
  if (!present) status_of_host |= kBodyMissing;
  return present;
}

/// What the host did to its bodies for its coming step.
void Site::Impl::lookAtBodies(double dt) noexcept {
  forEachBody([&](SiteBody& body) {
    body.is_told = false;
    if (body.bullet->isParked()) {
      if (body.bullet->isUndisturbed() && !body.bullet->hasMissedWorldGravity()) return;
      unpark(body);
    }
    body.is_told = true;
    body.change = body.bullet->takeHostChanges(dt);
    body.f_gravity_seen_W = body.bullet->gravityForce();
  });
  for (Neighbour& neighbour : neighbours) {
    if (!neighbour.bullet) continue;
    neighbour.linear_damping = neighbour.bullet->linearDamping();
    neighbour.angular_damping = neighbour.bullet->angularDamping();
  }
}

/// It goes to the island.
///
/// An impulse acts at once. A force acts over the step - over the next one, if the step's ticks
/// have been run already, and as much later as the host is late at its worst. The island's ticks
/// and the host's steps do not end together, so an account is kept of what is owed: a steady force
/// is steady, and no momentum is lost or made.
void Site::Impl::passHostChanges(double dt) noexcept {
  settleHostForces();
  const bool is_behind = settings.tick_source == TickSource::kHostStep;
  const double window_end = host_time + (is_behind ? dt : 2.0 * dt + host_lateness);
  const double rest = window_end - island_time;
  // Ticks that will run until the host is heard again: what is owed besides is paid over them.
  const double ticks_ahead = std::ceil((rest - kClockTolerance) / period());
  const double pay_over = std::max(ticks_ahead, 1.0) * period();
  forEachBody([&](SiteBody& body) {
    if (!body.is_told) return;
    const HostChange& change = body.change;
    if (change.moved) move(body, change);
    give(body, change.impulse_W - dt * change.f_W, change.angular_impulse_W - dt * change.t_W);

    body.owed_W = dropRounding(body.owed_W + dt * change.f_W);
    body.owed_angular_W = dropRounding(body.owed_angular_W + dt * change.t_W);
    body.f_host_W = change.f_W + (body.owed_W - rest * change.f_W) / pay_over;
    body.t_host_W = change.t_W + (body.owed_angular_W - rest * change.t_W) / pay_over;
    body.f_gravity_W = body.f_gravity_seen_W;
    setWorldWrench(body.index, body.f_gravity_W + body.f_host_W, body.t_host_W);
  });
  for (Neighbour& neighbour : neighbours)
    if (neighbour.bullet) followDamping(neighbour);
  host_force_end = window_end + dt;
  has_host_forces = true;
}

void Site::Impl::give(SiteBody& body, const Vec3& impulse_W,
                      const Vec3& angular_impulse_W) noexcept {
  if (impulse_W == Vec3::Zero() && angular_impulse_W == Vec3::Zero()) return;
  const RigidState before = island.state(body.index);
  island.applyImpulse(body.index, impulse_W, angular_impulse_W);
  countImpulse(body, before, impulse_W, angular_impulse_W);
  if (island_time > host_time) body.note({island_time, impulse_W, angular_impulse_W});
}

/// Books what the island has had of the host's forces since they were settled last.
void Site::Impl::settleHostForces() noexcept {
  const double had = island_time - host_force_settled;
  host_force_settled = island_time;
  forEachBody([&](SiteBody& body) {
    body.owed_W -= had * body.f_host_W;
    body.owed_angular_W -= had * body.t_host_W;
  });
}

/// A body that the host has put elsewhere: the island's body goes along, and so does what was kept
/// for the host's steps to come.
void Site::Impl::move(const SiteBody& body, const HostChange& change) noexcept {
  const auto moved = [&](RigidState state) {
    state.p_W += change.offset_W;
    state.q_WB = (change.rotation_W * state.q_WB).normalized();
    return state;
  };
  island.setState(body.index, moved(island.state(body.index)));
  passivity.refill();
  snapshots.forEachAfter(host_time + kClockTolerance, [&](std::vector<RigidState>& states) {
    states[body.index] = moved(states[body.index]);
  });
}

void Site::Impl::runTicksUntil(double time) noexcept {
  for (;;) {
    const double next = ticks == 0 ? host_time : start_time + static_cast<double>(ticks) * period();
    if (next >= time - kClockTolerance) return;
    tick(next);
  }
}

void Site::Impl::findEnds(double end) noexcept {
  const std::vector<RigidState>* states = snapshots.find(end, kClockTolerance);
  forEachBody([&](SiteBody& body) {
    body.end = states ? (*states)[body.index] : stateAt(body.index, end);
  });
  for (Remote& remote : remotes)
    if (remote.user.body) remote.ghost_seen = island.isGhost(*remote.user.body);
}

/// Bullet gets its bodies' states at the end of the step.
void Site::Impl::handOff(double dt) noexcept {
  for (Remote& remote : remotes) showGhost(remote);
  forEachBody([&](SiteBody& body) {
    body.stands = body.bullet->standsAt(body.end);
    if (body.bullet->isParked()) {
      if (body.stands) return;
      unpark(body);
    }
    if (has_host_jumped) body.bullet->setState(computeStart(body.end, dt));
    body.bullet->handOff(body.end, dt);
    ++counters.bodies_handed_off;
  });
}

/// State of a body where the host's step ended at a moment nobody had announced: cubic between the
/// ends of the latest tick or, for a host that is late, the nearest moments that were kept.
RigidState Site::Impl::stateAt(BodyIndex body, double time) noexcept {
  const RigidState& now = island.state(body);
  if (time >= island_time) return now;
  const RigidState& tick_start_state = tick_start_states[body];
  if (time >= tick_start) return interpolate(tick_start_state, tick_start, now, island_time, time);
  const auto place = static_cast<std::size_t>(body);
  const Snapshots::Moment from = snapshots.latestUntil(time), to = snapshots.earliestAfter(time);
  const bool is_kept = to.states && to.time < tick_start;
  const RigidState& after = is_kept ? (*to.states)[place] : tick_start_state;
  const double end = is_kept ? to.time : tick_start;
  if (from.states) return interpolate((*from.states)[place], from.time, after, end, time);
  return computeStart(after, std::min(end - time, period()));
}

}  // namespace tandem
