#include <algorithm>
#include <utility>

#include "site/site_impl.h"

// The account of what this side puts into the connection (PassivityObserver):
//
//   the hand             -f . dp, the force as rendered, over each tick: exact, as it is held
//   weight, host forces  f . dp + t . w dt of the bodies that the island moves
//   impulses             J . (v + v') / 2: the host's, and of contact with bodies that Bullet keeps
//   neighbours           their kinetic energy when the island takes them, and gives them back
//
// What the host moves by hand - a kinematic body, a body put elsewhere - has no measure: it fills
// the tank. Without hand-off Bullet moves the bodies and nobody knows what it did to them: then
// there is no account, and packets say so.

namespace tandem {
namespace {

double computeKineticEnergy(const IslandBody& body, const RigidState& state) noexcept {
  const Vec3 w_B = state.q_WB.conjugate() * state.w_W;
  return 0.5 * body.mass * state.v_W.squaredNorm() +
         0.5 * body.inertia_B.dot(w_B.cwiseProduct(w_B));
}

}  // namespace

bool Site::Impl::keepsAccount() const noexcept { return settings.passivity.enabled && isHandoff(); }

/// Over the tick that has just ended.
void Site::Impl::countHandWork() noexcept {
  if (status_now & kDeviceInvalid) {
    hand_before_W.reset();
    return;
  }
  if (hand_before_W) passivity.addOwn(-force_W.dot(sample.hip.p_W - *hand_before_W));
  hand_before_W = sample.hip.p_W;
}

/// The force and torque that the world has on a body of the island from now on.
void Site::Impl::setWorldWrench(BodyIndex body, const Vec3& f_W, const Vec3& t_W) noexcept {
  world_pushes |= f_W != Vec3::Zero() || t_W != Vec3::Zero();
  island.setExternalWrench(body, f_W, t_W);
}

/// Over the tick that has just been run; who slept when it began has had next to none.
void Site::Impl::countWorldWork() noexcept {
  if (!keepsAccount() || !world_pushes || start_rest.holds(island)) return;
  double work = 0.0;
  for (const BodyIndex b : moved_last) {
    const RigidState& state = island.state(b);
    work += island.externalForce(b).dot(state.p_W - tick_start_states[b].p_W) +
            period() * island.externalTorque(b).dot(state.w_W);
  }
  passivity.addOwn(work);
}

void Site::Impl::countImpulse(const SiteBody& body, const RigidState& before, const Vec3& impulse_W,
                              const Vec3& angular_impulse_W) noexcept {
  const RigidState& after = island.state(body.index);
  passivity.addOwn(0.5 * impulse_W.dot(before.v_W + after.v_W) +
                   0.5 * angular_impulse_W.dot(before.w_W + after.w_W));
}

void Site::Impl::countNeighbour(const Neighbour& neighbour, double sign) noexcept {
  passivity.addOwn(sign *
                   computeKineticEnergy(neighbour.settings, island.state(neighbour.body.index)));
}

/// What a packet says of energy, more than the one before; the first after a silence says where
/// the peer is, not what it did meanwhile. Of three sites that do not all hear each other, one
/// would see what another took and not what the third gave: then takings do not count.
void Site::Impl::hearEnergy(Remote& remote, const StatePacket& packet) noexcept {
  const std::optional<double> before = std::exchange(remote.reported, packet.port_energy);
  if (!before || !packet.port_energy) return;
  const double more = *packet.port_energy - *before;
  const auto is_heard = [&](const Remote& r) {
    return &r == &remote || r.health.state() == LinkState::kLive;
  };
  if (more > 0.0 || std::all_of(remotes.begin(), remotes.end(), is_heard))
    passivity.addReported(more);
}

/// The force that the hand may get over the coming tick.
Vec3 Site::Impl::limitEnergy(const Vec3& wanted_W) noexcept {
  if (wanted_W == Vec3::Zero() || !keepsAccount() || remotes.empty()) return wanted_W;
  const auto keeps_none = [](const Remote& r) { return r.heard && !r.latest.port_energy; };
  if (std::any_of(remotes.begin(), remotes.end(), keeps_none)) return wanted_W;
  const double share = passivity.computeShare(period() * wanted_W.dot(island.state(hip).v_W));
  if (share == 1.0) return wanted_W;
  ++counters.energy_limited;
  return share * wanted_W;
}

}  // namespace tandem
