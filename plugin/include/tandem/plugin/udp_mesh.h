#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tandem/coordination/configuration.h"
#include "tandem/coordination/datagram.h"
#include "tandem/coordination/playout_settings.h"
#include "tandem/coordination/types.h"
#include "tandem/plugin/address.h"
#include "tandem/plugin/secret_key.h"

#pragma GCC visibility push(default)
namespace tandem {

class Link;

/// Where the connection to a peer stands.
enum class PeerPhase {
  kCalling,    ///< no answer yet, or none for 5 s
  kAgreeing,   ///< there; configurations are being compared
  kDifferent,  ///< configurations differ: nothing is coupled
  kLive,       ///< states go both ways
  kLeft,       ///< the peer has said farewell
};

[[nodiscard]] const char* name(PeerPhase phase) noexcept;

/// Why a peer refuses, and what to do: "it has another key; give both sides the same key file".
[[nodiscard]] const char* explain(RefuseCode code) noexcept;

/// What a user may want to know of the connection to one peer.
struct PeerStatus {
  PeerId peer{};
  PeerPhase phase = PeerPhase::kCalling;
  std::optional<Address> address;  ///< where it was heard from last
  double silence = 0.0;            ///< since the last authentic datagram [s]
  double round_trip = 0.0;         ///< smoothed [s]
  double clock_offset = 0.0;       ///< peer's clock - own [s], if both ways take equally long
  double wait = 0.0;               ///< added by playout [s]
  double jitter = 0.0;             ///< that 99 % of the packets keep [s]
  double loss = 0.0;               ///< of the peer's packets, 0 to 1
  std::uint16_t key_epoch = 0;     ///< handshakes so far
  std::uint64_t states_sent = 0;
  std::uint64_t states_unsent = 0;    ///< outside what may be sent, such as beyond 1000 m
  std::uint64_t states_given = 0;     ///< to the site
  std::uint64_t states_stale = 0;     ///< overtaken: not given
  std::uint64_t states_too_late = 0;  ///< older than the rest by more than half a second
  std::optional<RefuseCode> refused;  ///< by the peer, or somebody who says so
  std::uint8_t refused_version = 0;   ///< that the refusing side speaks
  std::optional<ByeReason> left;      ///< why the peer has said farewell
  std::optional<ConfigurationDifference> difference;
};

/// A remote site and how it is reached.
struct UdpPeer {
  PeerId id{};
  std::optional<Address> address;  ///< nothing: it is to call us
  SecretKey key;                   ///< that this pair shares
};

struct UdpMeshSettings {
  PeerId self{1};
  Address bind;                 ///< port 0: any
  Configuration configuration;  ///< must be equal at all sites
  PlayoutSettings playout;
  WireProfile profile = WireProfile::kFloat32;
};

/// What came in so far, and why some of it was dropped; a name for each reason, as in
/// coordination/STANDARD.md.
struct RefusedDatagrams {
  std::string reason;
  std::uint64_t count = 0;
};

/// The ways to all remote sites over one UDP socket: sealed, replay-proof, with constant delay.
///
/// Used from the thread that ticks the site. poll() drains at most 128 datagrams and never blocks;
/// states cost no allocation, handshakes (at the start, every two minutes and after silence) some.
class UdpMesh {
 public:
  /// Throws std::invalid_argument for settings out of range or an address that cannot be bound,
  /// tandem::Error if the system gives no socket.
  UdpMesh(const UdpMeshSettings& settings, std::vector<UdpPeer> peers);
  ~UdpMesh();
  UdpMesh(const UdpMesh&) = delete;
  UdpMesh& operator=(const UdpMesh&) = delete;

  /// The way to a peer, for Site::connect(); lives as long as this. Throws std::invalid_argument
  /// for an id that is no peer.
  [[nodiscard]] Link& link(PeerId peer);

  /// Takes in what is there and says what is due. Call it before each tick. `now` [s] is the
  /// site's clock and must not run back.
  void poll(double now) noexcept;

  /// Waits until something comes in or so many seconds have passed.
  void wait(double seconds) const noexcept;

  /// Says farewell to all, and why: poll for another 100 ms until all have been told.
  void leave(double now, ByeReason reason = ByeReason::kUserLeaves) noexcept;

  [[nodiscard]] PeerStatus status(PeerId peer, double now) const;
  [[nodiscard]] std::uint64_t received() const noexcept;
  /// Reasons that occurred.
  [[nodiscard]] std::vector<RefusedDatagrams> refused() const;
  /// Where the socket is bound.
  [[nodiscard]] Address bound() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
