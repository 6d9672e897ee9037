#pragma once

#include <vector>

#include "tandem/plugin/site_settings.h"

#include "coordination/src/schemes/coordination_shares.h"
#include "site/bodies.h"
#include "site/membership.h"
#include "site/peer.h"
#include "site/session_frame.h"
#include "site/shares_ramp.h"
#include "site/site_log.h"

namespace tandem {

class EnergyPort;
class HostStep;

// clang-format off
/// The remote users: applies their packets and reduces their influence while they are silent.
///
///   object ties    a share of K and B; zero for a target not renewed since the peer came back
///   the proxy      a share of its coupler and contacts, with damping while they fade
///   lost, waiting  the proxy is a ghost, in the island and in Bullet
///   heard again    targets of objects move to the peer's copies, so that no spring is stretched;
///                  the ghost follows the user and returns where its place is free
///
/// Live peers skip all of this. For the thread that ticks; real-time safe except add().
// clang-format on
class Peers {
 public:
  Peers(const SiteSettings& settings, Island& island, Bodies& bodies, EnergyPort& energy,
        SiteLog& log);

  /// The stand-in of each remote user.
  [[nodiscard]] const StandInSettings& standIn() const noexcept { return stand_in_; }
  /// N, the number of sites that share the objects.
  [[nodiscard]] int countSites() const noexcept {
    return membership_.follows() ? membership_.count() : settings_.peers;
  }
  /// Who takes part, for the peers; empty if that is fixed.
  [[nodiscard]] std::optional<RollCall> tellRoll(double now) const noexcept {
    return membership_.tell(now);
  }
  /// Part of a body's mass that our copy of an object, or of a tool of this user, has.
  [[nodiscard]] double findMassShare(const std::optional<PeerId>& tool_of) const noexcept;

  [[nodiscard]] bool isEmpty() const noexcept { return peers_.empty(); }
  [[nodiscard]] int count() const noexcept { return static_cast<int>(peers_.size()); }
  [[nodiscard]] Peer& operator[](int place) noexcept { return peers_[place]; }
  [[nodiscard]] const Peer& operator[](int place) const noexcept { return peers_[place]; }
  [[nodiscard]] auto begin() noexcept { return peers_.begin(); }
  [[nodiscard]] auto end() noexcept { return peers_.end(); }
  [[nodiscard]] auto begin() const noexcept { return peers_.begin(); }
  [[nodiscard]] auto end() const noexcept { return peers_.end(); }

  /// Set-up. The scheme adds the user's representation to the island.
  [[nodiscard]] Peer make(PeerId id, Link& link, const Vec3& start_W);
  void add(Peer&& peer) { peers_.push_back(std::move(peer)); }
  /// Set-up: ties an object to peers' copies that it is not tied to yet. Calls `made` with the
  /// index and settings of each coupler.
  template <typename Made>
  void tie(const SharedObject& object, Made made);

  /// Arrival time of the next packet that is due before `until` [s]; `now` is the tick's start.
  [[nodiscard]] double nextArrival(double now, double until) noexcept;
  void takeInUntil(double time, double now) noexcept;
  /// Sends a packet to one of the peers, with its own energy report.
  void send(Peer& peer, StatePacket& packet, double time) noexcept;

  /// Where a peer's reset has an object that awaits to be put there.
  [[nodiscard]] RigidState findPlace(const SharedObject& object) const noexcept;
  /// Our copy is there: it is of the peer's epoch from now on.
  void finishPut(SharedObject& object) noexcept;
  /// Our copies that have been led to where a peer put them are of its epoch from now on. Called
  /// before a packet is made.
  void sayEpochs() noexcept;

  /// Called once a tick, before followLinks(): counts peers that came, and those that left no more.
  void followMembers(double now) noexcept;
  /// Called once a tick. `host_step` shows changes of a proxy in Bullet.
  void followLinks(double now, double period, HostStep& host_step) noexcept;

  /// Lets go of an object until the peers' next states of it: ours is held again.
  void awaitNews(const SharedObject& object) noexcept;
  /// The host put our copy elsewhere: begins an epoch. Peers' copies pull again when they are of
  /// it, too. Between them and ours a spring would throw both.
  void beginEpoch(SharedObject& object) noexcept;

  /// The host's world got another origin; packets stay in the frame of the session.
  void shiftOrigin(const Vec3& offset_W) noexcept;
  [[nodiscard]] const SessionFrame& frame() const noexcept { return frame_; }

  /// Notes that all obstacles around the proxies' present positions are known.
  void noteSearched() noexcept;

  /// True if all peers that were heard keep energy accounts.
  [[nodiscard]] bool keepAccounts() const noexcept { return keep_accounts_; }

 private:
  /// Of the gains with which ties to a peer's copies were made.
  [[nodiscard]] double tieShare(const Peer& peer) const noexcept {
    return peer.health.objectShare() * shares_.object / base_.object;
  }
  [[nodiscard]] CouplerSettings makeCoupler(const SharedObject& object) const noexcept;
  void takeIn(Peer& peer, Arrival& arrival, double time) noexcept;
  void beginAnew(Peer& peer, const StatePacket& packet) noexcept;
  void hear(Peer& peer, const StatePacket& packet, double time) noexcept;
  void hearEnergy(Peer& peer, const StatePacket& packet) noexcept;
  [[nodiscard]] bool isFoundElsewhere(const Tie& tie, const SharedObject& object,
                                      const ObjectState& copy) const noexcept;
  void noteJump(Peer& peer) noexcept;
  bool hearObjects(Peer& peer, const StatePacket& packet, double time) noexcept;
  [[nodiscard]] std::size_t findPatience(const Peer& peer) const noexcept;
  void letGoOfMissing(Peer& peer) noexcept;
  void awaitNews(const Peer& peer, Tie& tie) noexcept;

  // peer_epochs.cpp
  void enterEpoch(SharedObject& object, const ObjectEpoch& epoch) noexcept;
  void adopt(SharedObject& object, const ObjectState& copy, int leader) noexcept;
  [[nodiscard]] bool mayPut(const SharedObject& object) const noexcept;
  [[nodiscard]] bool isLed(const SharedObject& object) const noexcept;

  // peer_members.cpp
  void beginSharing(double now) noexcept;
  void beginJoin() noexcept;
  void moveShares(double now) noexcept;
  void applyStandIn(const Peer& peer) noexcept;
  void count(Peer& peer) noexcept;
  void followJoin() noexcept;
  void join(SharedObject& object, const Peer& leader) noexcept;
  [[nodiscard]] bool mayYetTell(const Peer& leader) const noexcept;
  [[nodiscard]] bool mustJoin(const SharedObject& object, const Peer& leader) const noexcept;
  [[nodiscard]] Peer* find(PeerId id) noexcept;

  // peer_restraint.cpp
  void followLink(Peer& peer, double now, double period, HostStep& host_step) noexcept;
  void followJump(Peer& peer, double now, double period) noexcept;
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
  Membership membership_;
  const CoordinationShares base_;  ///< of which couplers and stand-ins were made
  SharesRamp ramp_;                ///< to the shares of the present N
  CoordinationShares shares_;      ///< now
  StandInSettings stand_in_;       ///< now
  Island& island_;
  Bodies& bodies_;
  EnergyPort& energy_;
  SiteLog& log_;
  std::vector<Peer> peers_;
  SessionFrame frame_;
  bool keep_accounts_ = true;
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
