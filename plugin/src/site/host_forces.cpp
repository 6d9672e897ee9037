#include "site/host_forces.h"

#include <algorithm>
#include <cmath>

namespace tandem {
namespace {

/// Momentum below this is rounding, of the account or of Bullet's hand-off; it would keep bodies
/// awake [N s, N m s].
constexpr double kNoMomentum = 1e-15;

}  // namespace

Vec3 dropRounding(const Vec3& momentum) noexcept {
  return momentum.squaredNorm() < kNoMomentum * kNoMomentum ? Vec3(Vec3::Zero()) : momentum;
}

void HostForces::setWeight(SiteBody& body, const Vec3& f_gravity_W) noexcept {
  body.load.f_gravity_W = f_gravity_W;
  setWrench(body.index, f_gravity_W, Vec3::Zero());
}

void HostForces::renew(const SiteBody& body) noexcept {
  setWrench(body.index, body.load.f_gravity_W + body.load.f_host_W, body.load.t_host_W);
}

void HostForces::setWrench(BodyIndex body, const Vec3& f_W, const Vec3& t_W) noexcept {
  if (f_W != Vec3::Zero() || t_W != Vec3::Zero()) energy_.noteWorldForce();
  island_.setExternalWrench(body, f_W, t_W);
}

void HostForces::pass(double dt, bool is_behind) noexcept {
  settle();
  const double window_end = clock_.time() + (is_behind ? dt : 2.0 * dt + clock_.lateness());
  const double rest = window_end - timeline_.time();
  // The rest of the owed momentum is paid over the ticks that run before the host's next step.
  const double period = timeline_.period();
  const double ticks_ahead = std::ceil((rest - kClockTolerance) / period);
  const double pay_over = std::max(ticks_ahead, 1.0) * period;
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
  end_ = window_end + dt;
  are_on_ = true;
}

void HostForces::give(SiteBody& body, const Momentum& momentum) noexcept {
  if (momentum.isZero()) return;
  const RigidState before = island_.state(body.index);
  island_.applyImpulse(body.index, momentum.linear_W, momentum.angular_W);
  energy_.countImpulse(before, island_.state(body.index), momentum);
  if (timeline_.time() > clock_.time()) body.load.note({timeline_.time(), momentum});
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
    setWrench(body.index, body.load.f_gravity_W, Vec3::Zero());
  });
}

}  // namespace tandem
