#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "tandem/coordination/link.h"
#include "tandem/coordination/scheme.h"

#include "coordination/src/link/energy_ledger.h"
#include "coordination/src/link/link_health.h"
#include "coordination/src/schemes/remote_user.h"
#include "site/motion_limit.h"
#include "site/objects.h"
#include "site/proxy.h"
#include "site/restart_watch.h"
#include "site/tie.h"
#include "site/user_track.h"

namespace tandem {

/// A remote user at this site: its packets and its representation here.
struct Peer {
  PeerId id{};
  int place = 0;  ///< index among the peers, in the order of connect()
  Link* link = nullptr;

  // Packets received.
  std::optional<Arrival> pending;  ///< fetched, not yet applied
  StatePacket latest;
  bool is_heard = false;  ///< `latest` holds a packet
  RestartWatch restart;
  /// The peer restarted at this time of its own [s]: packets of before are dropped.
  double begun_at = -std::numeric_limits<double>::infinity();
  EnergyLedger ledger;
  bool keeps_account = true;  ///< as of its newest packet

  // Its representation here.
  RemoteUser user;
  UserTrack track;     ///< user state given to the scheme
  MotionLimit motion;  ///< of the user
  Proxy proxy;
  std::vector<Tie> ties;            ///< by object
  std::uint64_t packets_heard = 0;  ///< in any order
  std::uint64_t counted_at = 0;  ///< `packets_heard` when `is_counted` changed, or it began to lead
  std::size_t next_checked = 0;  ///< tie that is asked next whether its object is still sent

  // Its link, and the effects of silence.
  bool is_counted = true;  ///< it and this site count each other: Membership
  LinkHealth health{LinkLossSettings{}, 1.0};
  LinkState acted_on = LinkState::kLive;     ///< state of `health` that was last applied
  std::optional<std::uint64_t> rejoined_by;  ///< packet that ended its last silence
  bool is_detouring = false;                 ///< some object's target is on a detour
  bool is_restrained = false;                ///< gains or targets differ from a live peer's
  Vec3 searched_W = Vec3::Zero();            ///< where obstacles near the proxy were last searched

  /// False for an object that the peer has not sent since the peer or the object came back, or
  /// since our copy was put elsewhere, and while the peer does not take part.
  [[nodiscard]] bool isRenewed(const Tie& tie, const SharedObject& ours) const noexcept {
    const auto is_since = [&](const std::optional<std::uint64_t>& packet) {
      return !packet || (tie.sequence && *tie.sequence >= *packet);
    };
    return is_counted && is_since(rejoined_by) && is_since(tie.awaited) &&
           tie.epoch == ours.epoch && !ours.awaits_put;
  }
};

}  // namespace tandem
