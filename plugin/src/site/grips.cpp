#include "site/grips.h"

#include <algorithm>

namespace tandem {

Grips::Grips(const SiteSettings& settings, Island& island, const Bodies& bodies, LocalHand& hand,
             const Peers& peers, SiteLog& log, bool can_hold)
    : settings_(settings), island_(island), bodies_(bodies), hand_(hand), peers_(peers), log_(log) {
  if (can_hold) local_.emplace(settings, island, island.addGrip(hand.hip()), hand.hip());
}

void Grips::addPeer(const Peer& peer) {
  Remote& remote = remotes_.emplace_back();
  if (!canHold() || !peer.user.body) return;
  remote.hold.emplace(settings_, island_, island_.addGrip(*peer.user.body), *peer.user.body);
}

void Grips::grab(const SharedObject& object, const std::optional<Vec3>& at_B) noexcept {
  local_->begin(object, at_B);
  local_epoch_ = object.epoch;
  noteChange();
}

void Grips::release() noexcept {
  if (!local_ || !local_->isHolding()) return;
  local_->letGo();
  noteChange();
}

void Grips::noteChange() noexcept {
  ++epoch_;
  has_changed_ = is_new_ = true;
}

std::optional<Grip> Grips::grip() const noexcept {
  if (!isBusy()) return std::nullopt;
  const GripPull pull = local_->computePull();
  const GripState& state = local_->state();
  return Grip{*state.object, state.p_BG, pull.f_W, pull.t_W, !local_->isHolding()};
}

Vec3 Grips::computeTorque() const noexcept {
  if (!isBusy()) return Vec3::Zero();
  return -local_->computePull().t_W;
}

std::optional<GripState> Grips::state(double time) const noexcept {
  if (!has_changed_) return std::nullopt;
  GripState told;
  if (local_->isHolding()) told = local_->tell();
  told.epoch = epoch_;
  told.age = std::max(0.0, time - changed_at_);
  return told;
}

void Grips::follow(double now, double period) noexcept {
  if (!canHold()) return;
  if (local_->isOn()) followLocal(period);
  if (is_new_) changed_at_ = now;
  is_new_ = false;
  for (const Peer& peer : peers_) {
    Remote& remote = remotes_[static_cast<std::size_t>(peer.place)];
    if (remote.hold && (remote.hold->isOn() || peer.latest.grip))
      followPeer(peer, remote, now, period);
  }
}

void Grips::followLocal(double period) noexcept {
  const SharedObject& object = bodies_.objects[*local_->state().object];
  if (!object.body.is_held || object.epoch != local_epoch_) {
    // It left the island, or its host put it elsewhere.
    if (local_->isHolding()) noteChange();
    return local_->drop();
  }
  if (hand_.wrist()) local_->turn(*hand_.wrist());
  local_->follow(object, period, 1.0, countSites());
  hand_.energy().countLift(local_->takeWork());
  if (!local_->isHolding() || object.tool_of || local_->timeAtLimit() < settings_.grip.break_time ||
      local_->timeAtLimit() == 0.0)
    return;
  ++log_.counters.grips_broken;
  release();
}

/// Sites at which this hand, or its proxy, holds a copy. A proxy that fades counts for its share.
double Grips::countSites() const noexcept {
  double sites = 1.0;
  for (const Peer& peer : peers_)
    if (peer.user.body) sites += peer.health.proxyShare();
  return sites;
}

/// The object that a peer's user holds, if our copy is here and of the same epoch.
const SharedObject* Grips::findTold(const Peer& peer) const noexcept {
  const std::optional<GripState>& told = peer.latest.grip;
  if (!told || !told->object || *told->object >= peer.ties.size()) return nullptr;
  const SharedObject& object = bodies_.objects[*told->object];
  const bool is_here = object.body.is_held && peer.isRenewed(peer.ties[object.id], object);
  const bool may_hold = !object.tool_of || *object.tool_of == peer.id;
  return is_here && may_hold ? &object : nullptr;
}

void Grips::followPeer(const Peer& peer, Remote& remote, double now, double period) noexcept {
  GripHold& hold = *remote.hold;
  const std::optional<GripState>& told = peer.latest.grip;
  const SharedObject* object = findTold(peer);
  if (!told || !told->object) {
    hold.letGo();
  } else if (!object) {
    hold.drop();
  } else if (!hold.isHolding() || hold.state().epoch != told->epoch ||
             remote.epoch != object->epoch) {
    hold.begin(*told, *object);
    remote.epoch = object->epoch;
  }
  if (object && hold.isHolding()) hold.turn(*told, peer.latest.time);
  if (peer.health.isOverdue(now)) hold.stopTurning();
  if (!hold.isOn()) return;
  if (peer.health.isProxyOut()) return hold.pause();
  const SharedObject& held = bodies_.objects[*hold.state().object];
  if (!held.body.is_held) return hold.drop();
  const double share = peers_.standIn().share * peer.health.proxyShare();
  hold.follow(held, period, share, 0.0);
  hand_.energy().countLift(hold.takeWork());
}

}  // namespace tandem
