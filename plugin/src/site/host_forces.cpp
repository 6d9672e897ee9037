#include "site/host_forces.h"

#include <algorithm>
#include <cmath>

#include "bullet_bridge/src/bodies/rotation_vector.h"

namespace tandem {
namespace {

/// Momentum below this is rounding, of the account or of Bullet's hand-off; it would keep bodies
/// awake [N s, N m s].
constexpr double kNoMomentum = 1e-15;

/// A force that changed by less than this part of itself is the same: Bullet's rounding.
constexpr double kSamePart = 1e-6;

/// A body with less than this part of what a force gives it in a step stands: supports and friction
/// hold it.
constexpr double kStandingPart = 3e-4;

/// True if a force is that of the step before, or has just begun.
bool isEven(const Vec3& told_W, const Vec3& now_W) noexcept {
  return told_W == Vec3::Zero() || (now_W - told_W).norm() <= kSamePart * now_W.norm();
}

/// True if motion of this momentum is none beside `impulse_W`, a force or torque over a step.
bool stands(const Vec3& momentum_W, const Vec3& impulse_W) noexcept {
  return momentum_W.norm() <= kStandingPart * impulse_W.norm();
}

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
  giveImpulses(dt);
  bodies_.forEach([&](SiteBody& body) {
    body.step.gift = {};
    if (body.step.is_told) takeForces(body, window);
  });
  giveGifts();
  const HostChange none;
  bodies_.forEach([&](SiteBody& body) {
    if (!island_.body(body.index).is_rigid) return noteLate(body, body.step.gift);
    if (hasChanged(body)) moveOn(body, none);
  });
  end_ = window.end + dt;
  are_on_ = true;
}

/// Impulses act now.
void HostForces::giveImpulses(double dt) noexcept {
  bodies_.forEach([&](SiteBody& body) {
    const HostChange& change = body.step.change;
    body.step.gift = {};
    if (!body.step.is_told) return;
    body.step.gift = {change.impulse_W - dt * change.f_W,
                      change.angular_impulse_W - dt * change.t_W};
  });
  giveGifts();
  bodies_.forEach([&](SiteBody& body) { noteLate(body, body.step.gift); });
}

/// Spreads what is even of the host's wrench over its present step. The rest is a gift at its
/// start.
void HostForces::takeForces(SiteBody& body, const PayWindow& window) noexcept {
  const HostChange& change = body.step.change;
  const double dt = window.dt;
  HostLoad& load = body.load;
  const Wrench even = takeEvenPart(body, dt);
  load.told = {change.f_W, change.t_W};
  body.step.gift = {dt * (change.f_W - even.f_W), dt * (change.t_W - even.t_W)};

  load.owed.linear_W = dropRounding(load.owed.linear_W + dt * even.f_W);
  load.owed.angular_W = dropRounding(load.owed.angular_W + dt * even.t_W);
  load.f_host_W = even.f_W + (load.owed.linear_W - window.rest * even.f_W) / window.pay_over;
  load.t_host_W = even.t_W + (load.owed.angular_W - window.rest * even.t_W) / window.pay_over;
  load.f_gravity_W = body.step.f_gravity_W;
  renew(body);
  body.step.is_told = false;
}

/// Returns the part of the host's wrench that is spread over its present step of `dt` [s].
Wrench HostForces::takeEvenPart(SiteBody& body, double dt) const noexcept {
  const HostChange& change = body.step.change;
  const IslandBody& own = island_.body(body.index);
  const RigidState& state = island_.state(body.index);
  const Vec3 spin_B = own.inertia_B.cwiseProduct(state.q_WB.conjugate() * state.w_W);
  const Wrench& told = body.load.told;
  // A swinging body stands at its turning points, but not for two steps.
  const bool stands_now = stands(own.mass * state.v_W, dt * change.f_W);
  const bool is_still_now = stands(spin_B, dt * change.t_W);
  const bool is_even = isEven(told.f_W, change.f_W) || (stands_now && body.step.moves_not);
  const bool is_even_turn = isEven(told.t_W, change.t_W) || (is_still_now && body.step.turns_not);
  body.step.moves_not = stands_now;
  body.step.turns_not = is_still_now;
  return {is_even ? change.f_W : Vec3(Vec3::Zero()),
          is_even_turn ? change.t_W : Vec3(Vec3::Zero())};
}

void HostForces::push(const SiteBody& body, const Momentum& momentum) noexcept {
  const RigidState before = island_.state(body.index);
  island_.applyImpulse(body.index, momentum.linear_W, momentum.angular_W);
  energy_.countImpulse(before, island_.state(body.index),
                       undoFactors(island_.body(body.index), momentum));
}

void HostForces::give(SiteBody& body, const Momentum& momentum) noexcept {
  push(body, momentum);
  noteLate(body, momentum);
}

/// Gives all bodies their gifts. Joints answer at once, or the host would see for a step, and in
/// the way since its time, what they do not allow.
void HostForces::giveGifts() noexcept {
  bool is_any = false;
  bodies_.forEach([&](SiteBody& body) {
    const Momentum& gift = body.step.gift;
    body.step.before = island_.state(body.index);
    is_any |= !gift.isZero();
    island_.applyImpulse(body.index, gift.linear_W, gift.angular_W);
  });
  if (!is_any) return;
  island_.answerJoints();
  bodies_.forEach([&](SiteBody& body) {
    if (body.step.gift.isZero()) return;
    energy_.countImpulse(body.step.before, island_.state(body.index),
                         undoFactors(island_.body(body.index), body.step.gift));
  });
}

/// True if gifts, its own or another's through joints, changed the body's velocity.
bool HostForces::hasChanged(const SiteBody& body) const noexcept {
  const RigidState& after = island_.state(body.index);
  return after.v_W != body.step.before.v_W || after.w_W != body.step.before.w_W;
}

void HostForces::noteLate(SiteBody& body, const Momentum& momentum) noexcept {
  if (momentum.isZero() || timeline_.time() <= clock_.time()) return;
  body.load.note({timeline_.time(), momentum});
}

/// Gifts, and `shift`, were given at the host's time: ticks that have run since missed them.
void HostForces::moveOn(SiteBody& body, const HostChange& shift) noexcept {
  const RigidState before = body.step.before, after = island_.state(body.index);
  const Vec3 dv_W = after.v_W - before.v_W, dw_W = after.w_W - before.w_W;
  const double since = std::max(0.0, timeline_.time() - clock_.time());
  island_.shift(body.index, shift.offset_W + since * dv_W,
                makeRotation(since * dw_W) * shift.rotation_W);
  // Rigid contacts may have held the body back: on its way since the host's time, and beyond that
  // already there.
  const Vec3 way_W = since * dv_W;
  const Vec3 held_back_W = shift.offset_W + way_W - (island_.state(body.index).p_W - after.p_W);
  const double size = way_W.squaredNorm();
  const double part = size > 0.0 ? std::clamp(held_back_W.dot(way_W) / size, 0.0, 1.0) : 0.0;
  const Vec3 offset_W = shift.offset_W - (held_back_W - part * way_W);
  const auto change = [&](RigidState state, double time) {
    const double until = time - clock_.time();
    state.p_W += offset_W + (1.0 - part) * until * dv_W;
    state.q_WB = (makeRotation(until * dw_W) * shift.rotation_W * state.q_WB).normalized();
    state.v_W += dv_W;
    state.w_W += dw_W;
    return state;
  };
  // Newcomers catch up from the host's time on: a move from there to the next tick would look like
  // a speed of metres per millisecond.
  timeline_.changeKeptAfter(clock_.time() - kClockTolerance, body.index, change);
  body.step.end = change(body.step.end, clock_.time());
}

void HostForces::takeReactions(double dt) noexcept {
  bodies_.forEach([](SiteBody& body) { body.step.gift = body.step.hit; });
  giveGifts();
  bodies_.forEach([&](SiteBody& body) {
    HandOver& step = body.step;
    if (!island_.body(body.index).is_rigid) {
      // A proxy is led by springs, which a move would stretch.
      step.shift = {};
      return noteLate(body, step.gift);
    }
    // Bullet's solver acted when the host step ended.
    step.shift.moved |= hasChanged(body);
    if (step.shift.moved) moveOn(body, step.shift);
  });
  bodies_.forEach([&](SiteBody& body) {
    if (island_.body(body.index).is_rigid) expect(body, dt);
  });
}

/// Goes on with what acted on a rigid body in the host step of `dt` that has ended.
void HostForces::expect(SiteBody& body, double dt) noexcept {
  HandOver& step = body.step;
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

void HostForces::stop(SiteBody& body) noexcept {
  settle();
  HostLoad& load = body.load;
  load.f_host_W = load.t_host_W = Vec3::Zero();
  load.owed = {};
  load.late.clear();
  load.foresight.forget();
  load.press = {};
  setWeight(body, Vec3::Zero());
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
