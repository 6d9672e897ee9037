#include <algorithm>

#include "site/site_impl.h"

// What is left of a remote peer that falls silent. LinkHealth decides, here it is applied:
//
//   object couplers   share of K and B; a target not renewed since the peer came back has none
//   the proxy         share of its coupler and of all its contacts; damping while they fade
//   lost, waiting     the proxy is a ghost, in the island and in Bullet
//   heard again       objects are led to where the peer has them, with a spring that is not
//   stretched
//                     the ghost is carried to where the user is, and let in where nothing is
//
// Nothing of it is looked at while a peer is live.

namespace tandem {
namespace {

/// So far from where was searched last everything that stands is known [m].
constexpr double kKnownAround = 0.02;

}  // namespace

/// A state newer than all before.
void Site::Impl::hearRemote(Remote& remote, const StatePacket& packet, double time) noexcept {
  LinkHealth& health = remote.health;
  const double silence = health.isOverdue(time) ? health.computeAge(time) : 0.0;
  if (health.hear(time, packet.is_idle)) {
    remote.track.jump(packet.user);
    remote.rejoined_by = packet.sequence;
    remote.reported.reset();
  } else {
    remote.track.hear(packet.user, time, silence);
  }
  remote.velocity_share = 1.0;
  scheme.follow(island, remote.user, remote.track.at(time, 1.0));
}

void Site::Impl::followLinks(double now) noexcept {
  if (!settings.link_loss.enabled) return;
  for (Remote& remote : remotes)
    if (remote.is_restrained || !remote.health.staysLive(now)) followLink(remote, now);
}

void Site::Impl::followLink(Remote& remote, double now) noexcept {
  LinkHealth& health = remote.health;
  if (health.isProxyOut() && health.state() == LinkState::kRejoining) carryGhost(remote, now);
  health.update(now, !health.isProxyOut() || isPlaceFree(remote));
  const LinkState state = health.state(), before = remote.link_state;
  remote.link_state = state;
  if (state != before) countLinks();

  const bool is_silent = state == LinkState::kLost || state == LinkState::kWaiting;
  const bool is_heard = state == LinkState::kLive || state == LinkState::kRejoining;
  if (is_heard && remote.is_detouring) followDetours(remote);
  const bool is_calm =
      state == LinkState::kLive && !remote.track.isMakingUp(now) && !remote.is_detouring;
  if (remote.is_restrained ? is_silent && state == before : is_calm) return;
  remote.is_restrained = !is_calm;

  slowTargets(remote);
  if (!health.isProxyOut())
    scheme.follow(island, remote.user, remote.track.at(now, health.velocityShare()));
  restrainObjects(remote);
  restrainProxy(remote);
}

void Site::Impl::countLinks() noexcept {
  counters.links_faded = counters.links_lost = counters.links_rejoined = 0;
  for (const Remote& remote : remotes) {
    const LinkCounters& of_link = remote.health.counters();
    counters.links_faded += of_link.faded;
    counters.links_lost += of_link.lost;
    counters.links_rejoined += of_link.rejoined;
  }
}

/// Null where the host has deleted it, too.
btRigidBody* Site::Impl::findProxyBody(const Remote& remote) const noexcept {
  if (remote.held_proxy)
    return remote.held_proxy->isInWorld() ? &remote.held_proxy->rigid() : nullptr;
  return remote.proxy && remote.proxy->isAlive() ? &remote.proxy->rigid() : nullptr;
}

/// Nothing is where the proxy is, as far as that is known, and objects are where the user has them:
/// else it might come in on the wrong side of one, and hold it off from where it is pulled to.
bool Site::Impl::isPlaceFree(const Remote& remote) const noexcept {
  if (!remote.user.body) return true;
  const bool may_yet_agree = remote.health.objectShare() < 1.0 || remote.is_detouring;
  if (may_yet_agree && !doCopiesAgree(remote)) return false;
  const double allowed = settings.link_loss.rejoin_overlap;
  const double unknown = (island.state(*remote.user.body).p_W - remote.searched_W).norm();
  if (native) {
    const btRigidBody* rigid = findProxyBody(remote);
    return rigid && computeNativeOverlap(host_world.world(), *rigid) + unknown <= allowed;
  }
  if (!settings.guide && unknown > kKnownAround) return false;
  return island.computeOverlap(*remote.user.body) <= allowed;
}

/// What was searched around, proxies were in the middle of.
void Site::Impl::noteSearched() noexcept {
  for (Remote& remote : remotes)
    if (remote.user.body) remote.searched_W = island.state(*remote.user.body).p_W;
}

/// A ghost that may come back is where the user is.
void Site::Impl::carryGhost(const Remote& remote, double now) noexcept {
  if (!remote.user.body) return;
  const PointState user = remote.track.at(now, remote.health.velocityShare());
  RigidState state = island.state(*remote.user.body);
  state.p_W = user.p_W;
  state.v_W = user.v_W;
  island.setState(*remote.user.body, state);
}

/// The velocities of what shared objects are pulled to die away. A target of another packet than
/// the latest keeps what it has lost already.
void Site::Impl::slowTargets(Remote& remote) noexcept {
  const double share = remote.health.velocityShare();
  if (share == remote.velocity_share) return;
  const double ratio = remote.velocity_share > 0.0 ? share / remote.velocity_share : 0.0;
  remote.velocity_share = share;
  const auto place = static_cast<std::size_t>(&remote - remotes.data());
  for (const SharedObject& object : objects) {
    RigidState target = island.target(object.couplers[place]);
    target.v_W *= ratio;
    target.w_W *= ratio;
    island.setTarget(object.couplers[place], target);
  }
}

void Site::Impl::followDetours(Remote& remote) noexcept {
  const auto place = static_cast<std::size_t>(&remote - remotes.data());
  remote.is_detouring = false;
  for (SharedObject& object : objects) {
    Detour& detour = object.detours[place];
    if (detour.isOver()) continue;
    detour.advance(period());
    remote.is_detouring |= !detour.isOver();
    island.setTarget(object.couplers[place], detour.apply(object.theirs[place]));
  }
}

/// What was heard of an object before the peer fell silent is of no use.
bool Site::Impl::isRenewed(const Remote& remote, const SharedObject& object) const noexcept {
  if (remote.health.counters().rejoined == 0) return true;
  const std::optional<std::uint64_t>& newest = remote.object_sequences[object.id];
  return newest && *newest >= remote.rejoined_by;
}

bool Site::Impl::doCopiesAgree(const Remote& remote) const noexcept {
  const auto place = static_cast<std::size_t>(&remote - remotes.data());
  return std::all_of(objects.begin(), objects.end(), [&](const SharedObject& object) {
    const Vec3& theirs_W = object.theirs[place].p_W;
    const Vec3& ours_W = island.state(object.body.index).p_W;
    return isRenewed(remote, object) && (theirs_W - ours_W).norm() < settings.proxy.radius;
  });
}

void Site::Impl::restrainObjects(const Remote& remote) noexcept {
  const auto place = static_cast<std::size_t>(&remote - remotes.data());
  const double share = remote.health.objectShare();
  for (const SharedObject& object : objects)
    island.setCouplerShare(object.couplers[place], isRenewed(remote, object) ? share : 0.0);
}

/// In the host's world, by the host's thread.
void Site::Impl::showGhost(Remote& remote) noexcept {
  if (!remote.proxy || !remote.proxy->isAlive() || remote.ghost_seen == remote.ghost_shown) return;
  remote.ghost_shown = remote.ghost_seen;
  remote.proxy->setGhost(remote.ghost_seen);
}

void Site::Impl::restrainProxy(Remote& remote) noexcept {
  if (!remote.user.body) return;
  const BodyIndex body = *remote.user.body;
  const LinkHealth& health = remote.health;
  const bool is_out = health.isProxyOut();
  if (is_out != island.isGhost(body)) {
    island.setGhost(body, is_out);
    if (!desk.isOpen()) {
      remote.ghost_seen = is_out;
      showGhost(remote);
    }
    if (remote.held_proxy && remote.held_proxy->isInWorld())
      setNativeGhost(remote.held_proxy->rigid(), is_out);
    if (is_out) {
      RigidState state = island.state(body);
      state.v_W.setZero();
      island.setState(body, state);
    } else if (remote.proxy && !isHandoff()) {
      // Bullet moves it from here.
      remote.body.bullet->setState(island.state(body));
    }
  }
  island.setContactShare(body, health.proxyShare());
  if (!remote.user.coupler) return;
  const double rest_damping =
      computeRestDamping(settings.coordination, settings.proxy.mass, settings.link_loss.hold_decay);
  island.setCouplerShare(*remote.user.coupler, health.proxyShare());
  island.setExtraDamping(body, is_out ? 0.0 : health.silence() * rest_damping);
}

}  // namespace tandem
