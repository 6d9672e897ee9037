#include <algorithm>
#include <cmath>

#include "site_impl.h"

namespace tandem {
namespace {

/// How far the host's clock, summed up in btScalar, may be off the ticks' before a state counts as
/// another one [s].
constexpr double kClockTolerance = 1e-9;

}  // namespace

void Site::Impl::beforeHostStep(double dt) noexcept {
  const double end = host_time + dt;
  if (!allBodiesPresent()) {
    // The hand still gets its fading force.
    if (settings.tick_source == TickSource::kHostStep) runTicksUntil(end);
    return;
  }
  if (!isHandoff() && std::abs(dt - period()) > 1e-3 * period()) status_ever |= kHostStepWrong;

  host_step = dt;
  if (island_time < end) handoff_due = end;
  if (isHandoff()) passHostChanges(dt);
  if (settings.tick_source == TickSource::kHostStep) runTicksUntil(end);
  if (isHandoff()) {
    handOff(end, dt);
  } else {
    forEachBody([&](SiteBody& body) {
      if (island.isDynamic(body.index)) body.bullet->applyWrench(body.f_W, body.t_W, dt);
    });
  }
}

void Site::Impl::afterHostStep(double dt) noexcept {
  host_time += dt;
  if (!allBodiesPresent()) return;
  forEachBody([&](SiteBody& body) {
    if (isHandoff()) {
      // What Bullet's solver did besides: contact with neighbours that move.
      const HostChange change = body.bullet->restore();
      island.applyImpulse(body.index, change.impulse_W, change.angular_impulse_W);
    } else if (island.isDynamic(body.index)) {
      island.setState(body.index, body.bullet->state());
    } else {
      body.bullet->setState(island.state(body.index));
    }
  });
  // Announce the end of the next step, so that the island stops there for a moment even inside a
  // tick.
  handoff_due = host_time + dt;
  while (handoff_due <= island_time) handoff_due += dt;
  updateObstacles(dt);
}

bool Site::Impl::allBodiesPresent() noexcept {
  bool present = true;
  forEachBody([&](SiteBody& body) { present &= body.bullet->isInWorld(); });
  if (!present) status_ever |= kBodyMissing;
  return present;
}

/// What the host did to the bodies for its coming step goes to the island.
///
/// An impulse acts at once. A force acts over the step - over the next one, if the step's ticks
/// have been run already. The island's ticks and the host's steps do not end together, so an
/// account is kept of what is owed: a steady force is steady, and no momentum is lost or made.
void Site::Impl::passHostChanges(double dt) noexcept {
  settleHostForces();
  const bool is_behind = settings.tick_source == TickSource::kHostStep;
  const double window_end = host_time + (is_behind ? dt : 2.0 * dt);
  const double rest = window_end - island_time;
  // Ticks that will run until the host is heard again: what is owed besides is paid over them.
  const double ticks_ahead = std::ceil((rest - kClockTolerance) / period());
  const double pay_over = std::max(ticks_ahead, 1.0) * period();
  forEachBody([&](SiteBody& body) {
    const HostChange change = body.bullet->takeHostChanges(dt);
    if (change.moved) move(body, change, host_time + dt);
    island.applyImpulse(body.index, change.impulse_W - dt * change.f_W,
                        change.angular_impulse_W - dt * change.t_W);

    body.owed_W += dt * change.f_W;
    body.owed_angular_W += dt * change.t_W;
    body.f_host_W = change.f_W + (body.owed_W - rest * change.f_W) / pay_over;
    body.t_host_W = change.t_W + (body.owed_angular_W - rest * change.t_W) / pay_over;
    body.f_gravity_W = body.bullet->gravityForce();
    island.setExternalWrench(body.index, body.f_gravity_W + body.f_host_W, body.t_host_W);
  });
  host_force_end = window_end + dt;
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
/// for the end of this step.
void Site::Impl::move(const SiteBody& body, const HostChange& change, double step_end) noexcept {
  const auto moved = [&](RigidState state) {
    state.p_W += change.offset_W;
    state.q_WB = (change.rotation_W * state.q_WB).normalized();
    return state;
  };
  island.setState(body.index, moved(island.state(body.index)));
  if (auto* states = snapshots.find(step_end, kClockTolerance))
    (*states)[body.index] = moved((*states)[body.index]);
}

void Site::Impl::runTicksUntil(double time) noexcept {
  for (;;) {
    const double next = ticks == 0 ? host_time : start_time + static_cast<double>(ticks) * period();
    if (next >= time - kClockTolerance) return;
    tick(next);
  }
}

void Site::Impl::handOff(double end, double dt) noexcept {
  const std::vector<RigidState>* states = snapshots.find(end, kClockTolerance);
  forEachBody([&](SiteBody& body) {
    body.bullet->handOff(states ? (*states)[body.index] : stateAt(body.index, end), dt);
  });
}

/// State of a body inside the latest tick, where the host's step ended at a moment nobody had
/// announced: cubic between the tick's ends, which is right to about w^4 h^4 / 384 of the motion.
RigidState Site::Impl::stateAt(BodyIndex body, double time) const noexcept {
  const RigidState& a = tick_start_states[body];
  const RigidState& b = island.state(body);
  const double h = island_time - tick_start;
  if (!(h > 0.0) || time >= island_time) return b;
  const double s = std::max(0.0, (time - tick_start) / h);
  RigidState state;
  const double s2 = s * s, s3 = s2 * s;
  state.p_W = (2 * s3 - 3 * s2 + 1) * a.p_W + (s3 - 2 * s2 + s) * h * a.v_W +
              (3 * s2 - 2 * s3) * b.p_W + (s3 - s2) * h * b.v_W;
  state.v_W = (6 * s2 - 6 * s) / h * (a.p_W - b.p_W) + (3 * s2 - 4 * s + 1) * a.v_W +
              (3 * s2 - 2 * s) * b.v_W;
  state.q_WB = a.q_WB.slerp(s, b.q_WB);
  state.w_W = (1 - s) * a.w_W + s * b.w_W;
  return state;
}

void Site::Impl::updateObstacles(double dt) {
  // The enclosure of a guide has no end, and nothing else in it.
  if (settings.guide) return;
  double speed = 0.0;
  for (std::size_t b = 0; b < scratch_states.size(); ++b) {
    scratch_states[b] = island.state(static_cast<BodyIndex>(b));
    speed = std::max(speed, scratch_states[b].v_W.norm());
  }
  // Far enough that nothing can come as near as a contact before the host is asked again, even if
  // it is late.
  obstacles.update(scratch_states, 0.04 + 1.5 * speed * 2.5 * dt);
  island.setObstacles(obstacles.nearSpheres());
}

}  // namespace tandem
