#pragma once

#include <vector>

#include "tandem/plugin/site_settings.h"

#include "site/bodies.h"
#include "site/peer.h"
#include "site/site_log.h"

namespace tandem {

class EnergyPort;
class HostStep;

/// The remote users: takes in what they say and follows what their silence leaves.
///
///   object ties       share of K and B; a target not renewed since the peer came back has none
///   the proxy         share of its coupler and of all its contacts; damping while they fade
///   lost, waiting     the proxy is a ghost, in the island and in Bullet
///   heard again       objects are led to where the peer has them, so that no spring is stretched;
///                     the ghost is carried to where the user is, and let in where nothing is
///
/// Nothing of it is looked at while a peer is live. For whoever ticks; real-time safe but add().
class Peers {
 public:
  Peers(const SiteSettings& settings, Island& island, Bodies& bodies, EnergyPort& energy,
        SiteLog& log);

  [[nodiscard]] bool isEmpty() const noexcept { return peers_.empty(); }
  [[nodiscard]] int count() const noexcept { return static_cast<int>(peers_.size()); }
  [[nodiscard]] Peer& operator[](int place) noexcept { return peers_[place]; }
  [[nodiscard]] const Peer& operator[](int place) const noexcept { return peers_[place]; }
  [[nodiscard]] auto begin() noexcept { return peers_.begin(); }
  [[nodiscard]] auto end() noexcept { return peers_.end(); }
  [[nodiscard]] auto begin() const noexcept { return peers_.begin(); }
  [[nodiscard]] auto end() const noexcept { return peers_.end(); }

  /// Set-up. The scheme makes what stands for the user in the island.
  [[nodiscard]] Peer make(PeerId id, Link& link, const Vec3& start_W);
  void add(Peer&& peer) { peers_.push_back(std::move(peer)); }
  /// Set-up: ties an object to the copies of peers that it is not tied to yet. Calls `made` with
  /// the index and settings of each coupler.
  template <typename Made>
  void tie(const SharedObject& object, Made made);

  /// When the next packet arrives that is due before `until` [s]; `now` is the tick's start.
  [[nodiscard]] double nextArrival(double now, double until) noexcept;
  void takeInUntil(double time, double now) noexcept;
  void send(const StatePacket& packet, double time) noexcept {
    for (Peer& peer : peers_) peer.link->send(packet, time);
  }

  /// Once a tick. `host_step` shows in Bullet what changes of a proxy.
  void followLinks(double now, double period, HostStep& host_step) noexcept;

  /// Around where proxies are now all that stands is known.
  void noteSearched() noexcept;

  /// True if there are peers, and all that were heard keep accounts of energy.
  [[nodiscard]] bool keepAccounts() const noexcept;

 private:
  [[nodiscard]] CouplerSettings makeCoupler(const SharedObject& object) const noexcept;
  void takeIn(Peer& peer, const Arrival& arrival, double time) noexcept;
  void hear(Peer& peer, const StatePacket& packet, double time) noexcept;
  void hearEnergy(Peer& peer, const StatePacket& packet) noexcept;
  bool hearObjects(Peer& peer, const StatePacket& packet) noexcept;

  // peer_restraint.cpp
  void followLink(Peer& peer, double now, double period, HostStep& host_step) noexcept;
  void countLinks() noexcept;
  [[nodiscard]] bool mayComeIn(const Peer& peer, const HostStep& host_step) const noexcept;
  [[nodiscard]] bool doCopiesAgree(const Peer& peer) const noexcept;
  void carryGhost(const Peer& peer, double now) noexcept;
  void slowTargets(Peer& peer) noexcept;
  void followDetours(Peer& peer, double period) noexcept;
  void restrainTies(const Peer& peer) noexcept;
  void restrainProxy(Peer& peer, HostStep& host_step) noexcept;

  const SiteSettings& settings_;
  const Scheme& scheme_;
  Island& island_;
  Bodies& bodies_;
  EnergyPort& energy_;
  SiteLog& log_;
  std::vector<Peer> peers_;
};

template <typename Made>
void Peers::tie(const SharedObject& object, Made made) {
  const CouplerSettings coupler = makeCoupler(object);
  for (Peer& peer : peers_) {
    if (peer.ties.size() > object.id) continue;
    Tie& tie = peer.ties.emplace_back();
    tie.coupler = island_.addCoupler(object.body.index, coupler);
    tie.theirs = island_.state(object.body.index);
    made(tie.coupler, coupler);
  }
}

}  // namespace tandem
