#include "site/host_forces.h"

#include <algorithm>
#include <cmath>

#include "bullet_bridge/src/bodies/rotation_vector.h"

namespace tandem {
namespace {

/// Momentum below this is rounding, of the account or of Bullet's hand-off; it would keep bodies
/// awake [N s, N m s].
constexpr double kNoMomentum = 1e-15;

Vec3 undoFactor(const Vec3& felt_W, const Vec3& factor) noexcept {
  return (factor.array() > 0.0).select(felt_W.array() / factor.array(), 0.0);
}

/// Momentum, or its rate, before the factors that Bullet has applied: the island applies its own.
Momentum undoFactors(const IslandBody& body, const Momentum& felt) noexcept {
  if (!body.hasFactors()) return felt;
  return {undoFactor(felt.linear_W, body.linear_factor),
          undoFactor(felt.angular_W, body.angular_factor)};
}

}  // namespace

Vec3 dropRounding(const Vec3& momentum) noexcept {
  return momentum.squaredNorm() < kNoMomentum * kNoMomentum ? Vec3(Vec3::Zero()) : momentum;
}

void HostForces::setWeight(SiteBody& body, const Vec3& f_gravity_W) noexcept {
  body.load.f_gravity_W = f_gravity_W;
  setWrench(body.index, f_gravity_W, Vec3::Zero());
}

void HostForces::renew(const SiteBody& body) noexcept {
  const HostLoad& load = body.load;
  setWrench(body.index, load.f_gravity_W + load.f_host_W + load.foresight.force() + load.press.f_W,
            load.t_host_W + load.foresight.torque() + load.press.t_W);
}

void HostForces::setWrench(BodyIndex body, const Vec3& f_W, const Vec3& t_W) noexcept {
  if (f_W != Vec3::Zero() || t_W != Vec3::Zero()) energy_.noteWorldForce();
  const Momentum push = undoFactors(island_.body(body), {f_W, t_W});
  island_.setExternalWrench(body, push.linear_W, push.angular_W);
}

PayWindow HostForces::findWindow(double dt, bool is_behind) const noexcept {
  const double end = clock_.time() + (is_behind ? dt : 2.0 * dt + clock_.lateness());
  const double rest = end - timeline_.time();
  // The rest of the owed momentum is paid over the ticks that run before the host's next step.
  const double period = timeline_.period();
  const double ticks_ahead = std::ceil((rest - kClockTolerance) / period);
  return {dt, end, rest, std::max(ticks_ahead, 1.0) * period};
}

void HostForces::pass(double dt, bool is_behind) noexcept {
  settle();
  const PayWindow window = findWindow(dt, is_behind);
  const double rest = window.rest, pay_over = window.pay_over;
  bodies_.forEach([&](SiteBody& body) {
    if (!body.step.is_told) return;
    const HostChange& change = body.step.change;
    give(body, {change.impulse_W - dt * change.f_W, change.angular_impulse_W - dt * change.t_W});

    HostLoad& load = body.load;
    load.owed.linear_W = dropRounding(load.owed.linear_W + dt * change.f_W);
    load.owed.angular_W = dropRounding(load.owed.angular_W + dt * change.t_W);
    load.f_host_W = change.f_W + (load.owed.linear_W - rest * change.f_W) / pay_over;
    load.t_host_W = change.t_W + (load.owed.angular_W - rest * change.t_W) / pay_over;
    load.f_gravity_W = body.step.f_gravity_W;
    renew(body);
    body.step.is_told = false;
  });
  end_ = window.end + dt;
  are_on_ = true;
}

void HostForces::push(const SiteBody& body, const Momentum& momentum) noexcept {
  const RigidState before = island_.state(body.index);
  island_.applyImpulse(body.index, momentum.linear_W, momentum.angular_W);
  energy_.countImpulse(before, island_.state(body.index),
                       undoFactors(island_.body(body.index), momentum));
}

void HostForces::give(SiteBody& body, const Momentum& momentum) noexcept {
  if (momentum.isZero()) return;
  push(body, momentum);
  if (timeline_.time() > clock_.time()) body.load.note({timeline_.time(), momentum});
}

/// Bullet's solver acted when the host step ended. Ticks that have run since missed its impulses.
void HostForces::takeReaction(SiteBody& body, double dt) noexcept {
  HandOver& step = body.step;
  if (!island_.body(body.index).is_rigid) {
    // A proxy is led by springs, which a move would stretch.
    step.shift = {};
    return give(body, step.hit);
  }
  if (!step.hit.isZero() || step.shift.moved) {
    const RigidState before = island_.state(body.index);
    push(body, step.hit);
    const RigidState after = island_.state(body.index);
    const Vec3 dv_W = after.v_W - before.v_W, dw_W = after.w_W - before.w_W;
    const double since = std::max(0.0, timeline_.time() - clock_.time());
    island_.shift(body.index, step.shift.offset_W + since * dv_W,
                  makeRotation(since * dw_W) * step.shift.rotation_W);
    // Rigid contacts may have held the body back: on its way since the end of the step, and beyond
    // that already there.
    const Vec3 way_W = since * dv_W;
    const Vec3 held_back_W =
        step.shift.offset_W + way_W - (island_.state(body.index).p_W - after.p_W);
    const double size = way_W.squaredNorm();
    const double part = size > 0.0 ? std::clamp(held_back_W.dot(way_W) / size, 0.0, 1.0) : 0.0;
    const Vec3 offset_W = step.shift.offset_W - (held_back_W - part * way_W);
    const auto change = [&](RigidState state, double time) {
      const double until = time - clock_.time();
      state.p_W += offset_W + (1.0 - part) * until * dv_W;
      state.q_WB = (makeRotation(until * dw_W) * step.shift.rotation_W * state.q_WB).normalized();
      state.v_W += dv_W;
      state.w_W += dw_W;
      return state;
    };
    // Newcomers catch up from the end of the step on: a move from there to the next tick would look
    // like a speed of metres per millisecond.
    timeline_.changeKeptAfter(clock_.time() - kClockTolerance, body.index, change);
    step.end = change(step.end, clock_.time());
    step.shift.moved = true;
  }
  const bool was_none = body.load.foresight.isNone() && body.load.press.isNone();
  body.load.press.expect(dt, step.lasting_support);
  const Momentum kick = body.load.foresight.expect(timeline_.time(), dt, step.reaction);
  if (was_none && kick.isZero() && body.load.press.isNone()) return;
  const RigidState before = island_.state(body.index);
  push(body, kick);
  step.end.v_W += island_.state(body.index).v_W - before.v_W;
  step.end.w_W += island_.state(body.index).w_W - before.w_W;
  renew(body);
}

void HostForces::forgetForesight(SiteBody& body) noexcept {
  body.load.foresight.forget();
  renew(body);
}

Momentum HostForces::computeOwed(const SiteBody& body) noexcept {
  settle();
  const double ahead = std::max(0.0, timeline_.time() - clock_.time());
  const HostLoad& load = body.load;
  Momentum owed{load.owed.linear_W + ahead * load.f_host_W,
                load.owed.angular_W + ahead * load.t_host_W};
  for (const LateMomentum& late : load.late) {
    if (late.time <= clock_.time()) continue;
    owed.linear_W += late.momentum.linear_W;
    owed.angular_W += late.momentum.angular_W;
  }
  return owed;
}

void HostForces::forgetLate(SiteBody& body) noexcept {
  std::erase_if(body.load.late,
                [&](const LateMomentum& late) { return late.time <= clock_.time(); });
}

void HostForces::settle() noexcept {
  const double had = timeline_.time() - settled_;
  settled_ = timeline_.time();
  bodies_.forEach([&](SiteBody& body) {
    body.load.owed.linear_W -= had * body.load.f_host_W;
    body.load.owed.angular_W -= had * body.load.t_host_W;
  });
}

void HostForces::end() noexcept {
  are_on_ = false;
  settle();
  bodies_.forEach([&](SiteBody& body) {
    body.load.f_host_W = body.load.t_host_W = Vec3::Zero();
    body.load.foresight.end(timeline_.time());
    body.load.press = {};
    setWrench(body.index, body.load.f_gravity_W, Vec3::Zero());
  });
}

}  // namespace tandem
