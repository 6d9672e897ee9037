#pragma once

#include <optional>
#include <vector>

#include "tandem/coordination/link.h"
#include "tandem/coordination/scheme.h"

#include "coordination/src/link/link_health.h"
#include "coordination/src/schemes/remote_user.h"
#include "site/proxy.h"
#include "site/tie.h"
#include "site/user_track.h"

namespace tandem {

/// A remote user at this site: what it said, and what stands for it here.
struct Peer {
  PeerId id{};
  int place = 0;  ///< among the peers, in the order of connect()
  Link* link = nullptr;

  // What it said.
  std::optional<Arrival> pending;  ///< fetched, not yet taken in
  StatePacket latest;
  bool is_heard = false;           ///< `latest` is a packet
  std::optional<double> reported;  ///< energy that it has put in, as heard last [J]

  // What stands for it here.
  RemoteUser user;
  UserTrack track;  ///< of the user, as the scheme is told
  Proxy proxy;
  std::vector<Tie> ties;  ///< by object

  // What its silence has left of that.
  LinkHealth health{LinkLossSettings{}, 1.0};
  LinkState acted_on = LinkState::kLive;     ///< state of `health` that was acted on last
  std::optional<std::uint64_t> rejoined_by;  ///< packet with which it came back last
  bool is_detouring = false;                 ///< some object's target is not where its copy is
  bool is_restrained = false;                ///< something is not as with a live peer
  Vec3 searched_W = Vec3::Zero();            ///< around here what is near the proxy is known

  /// False for an object that the peer has not told of since it came back.
  [[nodiscard]] bool isRenewed(const Tie& tie) const noexcept {
    return !rejoined_by || (tie.sequence && *tie.sequence >= *rejoined_by);
  }
};

}  // namespace tandem
