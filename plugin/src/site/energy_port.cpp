#include "site/energy_port.h"

#include "site/timeline.h"

namespace tandem {
namespace {

/// Velocity of a body without factors that has the same energy. A locked axis gives none.
Vec3 computeFreeVelocity(const Vec3& v_W, const Vec3& factor) noexcept {
  return (factor.array() > 0.0).select(v_W.array() / factor.array().sqrt(), 0.0);
}

double computeKineticEnergy(const IslandBody& body, const RigidState& state) noexcept {
  const Vec3 v_W = computeFreeVelocity(state.v_W, body.linear_factor);
  const Vec3 w_B = state.q_WB.conjugate() * computeFreeVelocity(state.w_W, body.angular_factor);
  return 0.5 * body.mass * v_W.squaredNorm() + 0.5 * body.inertia_B.dot(w_B.cwiseProduct(w_B));
}

}  // namespace

void EnergyPort::countWorld(const Island& island, const Timeline& timeline) noexcept {
  if (!is_kept_ || !world_pushes_ || timeline.sleptSinceStart()) return;
  double work = 0.0;
  timeline.forEachMoved([&](BodyIndex b, const RigidState& start) {
    const RigidState& state = island.state(b);
    work += island.externalForce(b).dot(state.p_W - start.p_W) +
            timeline.period() * island.externalTorque(b).dot(state.w_W);
  });
  observer_.addWorld(work);
}

void EnergyPort::countImpulse(const RigidState& before, const RigidState& after,
                              const Momentum& impulse) noexcept {
  observer_.addWorld(0.5 * impulse.linear_W.dot(before.v_W + after.v_W) +
                     0.5 * impulse.angular_W.dot(before.w_W + after.w_W));
}

void EnergyPort::countNeighbour(const IslandBody& body, const RigidState& state,
                                double sign) noexcept {
  observer_.addWorld(sign * computeKineticEnergy(body, state));
}

std::optional<EnergyReport> EnergyPort::report(EnergyLedger& ledger, int sites) noexcept {
  if (!is_kept_) return std::nullopt;
  if (sites > 1) observer_.addMoved(-ledger.grant(observer_.available(), settings_.tank, sites));
  return ledger.report(observer_.available());
}

void EnergyPort::credit(double most, bool keeps_all) noexcept {
  const double received = keeps_all ? std::min(waiting_, most) : most;
  waiting_ = std::max(0.0, waiting_ - received);
  observer_.addMoved(received);
}

/// With the impulse J = f T and the least mass m, the hand gets J . v + J^2 / (2 m), and up to
/// |J| |dv| / 2 <= J^2 / (4 m) + m dv^2 / 4 by the change dv of its velocity.
double EnergyPort::computeShare(const Vec3& wanted_W, double turning, const Vec3& v_W,
                                const Vec3& change_W, double duration) noexcept {
  const double m = settings_.least_mass;
  const TickEnergy whole{
      duration * (wanted_W.dot(v_W) + turning) + 0.25 * m * change_W.squaredNorm(),
      0.75 * duration * duration / m * wanted_W.squaredNorm()};
  const double share = observer_.computeShare(whole);
  limited_ += share != 1.0;
  return share;
}

}  // namespace tandem
