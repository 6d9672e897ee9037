#include "site/energy_port.h"

#include "site/timeline.h"

namespace tandem {
namespace {

double computeKineticEnergy(const IslandBody& body, const RigidState& state) noexcept {
  const Vec3 w_B = state.q_WB.conjugate() * state.w_W;
  return 0.5 * body.mass * state.v_W.squaredNorm() +
         0.5 * body.inertia_B.dot(w_B.cwiseProduct(w_B));
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

void EnergyPort::receive(double period, bool keeps_all) noexcept {
  const double most = settings_.power * period;
  const double received = keeps_all ? std::min(waiting_, most) : most;
  if (received == 0.0) return;
  waiting_ = std::max(0.0, waiting_ - received);
  observer_.addMoved(received);
}

Vec3 EnergyPort::limit(const Vec3& wanted_W, const Vec3& v_W, double change,
                       double duration) noexcept {
  const double impulse = duration * wanted_W.norm();
  const TickEnergy whole{duration * wanted_W.dot(v_W) + 0.5 * impulse * change,
                         0.5 * impulse * impulse / settings_.least_mass};
  const double share = observer_.computeShare(whole);
  if (share == 1.0) return wanted_W;
  ++limited_;
  return share * wanted_W;
}

}  // namespace tandem
