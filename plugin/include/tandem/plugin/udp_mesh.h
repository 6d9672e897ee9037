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

class DatagramCarrier;
class Link;

/// Phase of the connection to a peer.
enum class PeerPhase {
  kCalling,    ///< no answer yet, or none for 5 s
  kAgreeing,   ///< the peer answers; configurations are being compared
  kDifferent,  ///< configurations differ: nothing is coupled
  kLive,       ///< states are exchanged
  kLeft,       ///< the peer said farewell
};

[[nodiscard]] const char* name(PeerPhase phase) noexcept;

/// Reason and remedy of a refusal: "it has another key; give both sides the same key file".
[[nodiscard]] const char* explain(RefuseCode code) noexcept;

/// Status of the connection to one peer.
struct PeerStatus {
  PeerId peer{};
  PeerPhase phase = PeerPhase::kCalling;
  std::optional<Address> address;     ///< at which the peer is
  bool is_relayed = false;            ///< it is reached through the relay, at the relay's address
  std::uint64_t address_changes = 0;  ///< how often it was found at another one
  double silence = 0.0;               ///< since the last authentic datagram [s]
  double round_trip = 0.0;            ///< smoothed [s]
  double clock_offset = 0.0;          ///< peer's clock - own [s], if both ways take equal time
  double wait = 0.0;                  ///< delay added by playout [s]
  double jitter = 0.0;                ///< 99 % of the packets stay within it [s]
  double loss = 0.0;            ///< lost fraction of the peer's states in the last second, 0 to 1
  std::uint16_t key_epoch = 0;  ///< handshakes so far
  std::uint64_t states_sent = 0;
  std::uint64_t states_unsent = 0;    ///< not encodable, such as beyond 1000 m
  std::uint64_t states_given = 0;     ///< passed to the site
  std::uint64_t states_stale = 0;     ///< overtaken by a newer one: dropped
  std::uint64_t states_too_late = 0;  ///< more than 0.5 s older than the rest: dropped
  std::optional<RefuseCode> refused;  ///< reason sent by the peer, or in its name: not authentic
  std::uint8_t refused_version = 0;   ///< protocol version of the refusing side
  bool is_called_with_another_key = false;  ///< somebody calls in the peer's name: not authentic
  std::optional<ByeReason> left;            ///< reason of the peer's farewell
  std::optional<ConfigurationDifference> difference;
};

/// A remote site and its address.
struct UdpPeer {
  PeerId id{};
  std::optional<Address> address;  ///< empty: the peer calls us
  SecretKey key;                   ///< key shared by this pair
};

/// A room of a relay in which the peers are, too: the way to each of them where no direct one
/// answers, or the relay is faster.
struct RelayAccess {
  Address address;   ///< of the relay
  SecretKey key;     ///< the relay's, other than those of pairs
  std::string room;  ///< 1 to 32 letters, digits, '.', '_' or '-'
  /// Shared with spectators, who get 32 states a second (watcher.h); empty: there are none. It
  /// opens nothing at a site.
  std::optional<SecretKey> watch_key = std::nullopt;
};

/// State of the connection to the relay.
struct RelayConnection {
  bool is_in = false;       ///< the relay has let this site into the room
  double silence = 0.0;     ///< since its last answer, one comes each second [s]
  double round_trip = 0.0;  ///< to the relay and back, smoothed [s]
  std::string refused;      ///< reason and remedy why it lets nobody in; empty: none. Not authentic
};

struct UdpMeshSettings {
  PeerId self{1};
  Address bind;                 ///< port 0: any free port
  Configuration configuration;  ///< must be equal at all sites
  PlayoutSettings playout;
  WireProfile profile = WireProfile::kFloat32;
  /// Told to spectators in place of the configuration's hash, such as one that stays while gains
  /// change.
  std::optional<std::uint32_t> watch_hash = std::nullopt;
  DatagramCarrier* carrier = nullptr;  ///< instead of UDP, must outlive the mesh; `bind` is unused
};

/// Number of datagrams that were dropped for one reason. coordination/STANDARD.md lists the
/// reasons.
struct RefusedDatagrams {
  std::string reason;
  std::uint64_t count = 0;
};

/// Links to all remote sites over one UDP socket, or by a carrier: sealed, protected against
/// replay, with constant delay.
///
/// For the thread that ticks the site. poll() takes at most 128 datagrams and never blocks. States
/// need no allocation. Handshakes allocate: at the start, every two minutes and after silence.
class UdpMesh {
 public:
  /// Throws std::invalid_argument for settings out of range or an address that cannot be bound.
  /// Throws tandem::Error if the system gives no socket.
  /// With a relay no peer needs an address. With a carrier none has one, and a relay is refused.
  UdpMesh(const UdpMeshSettings& settings, std::vector<UdpPeer> peers,
          std::optional<RelayAccess> relay = std::nullopt);
  ~UdpMesh();
  UdpMesh(const UdpMesh&) = delete;
  UdpMesh& operator=(const UdpMesh&) = delete;

  /// Link to a peer, for Site::connect(); lives as long as the mesh. Throws std::invalid_argument
  /// if `peer` is unknown.
  [[nodiscard]] Link& link(PeerId peer);

  /// Takes the received datagrams and sends the due ones. Call it before each tick. `now` [s] is
  /// the site's clock and must not run back.
  void poll(double now) noexcept;

  /// Waits for a datagram, at most `seconds`.
  void wait(double seconds) const noexcept;

  /// Says farewell to all peers with `reason`. Poll for another 100 ms, so that all are told.
  void leave(double now, ByeReason reason = ByeReason::kUserLeaves) noexcept;

  [[nodiscard]] PeerStatus status(PeerId peer, double now) const;
  /// Empty without a relay.
  [[nodiscard]] std::optional<RelayConnection> relay(double now) const;
  [[nodiscard]] std::uint64_t received() const noexcept;
  /// Reasons that occurred so far.
  [[nodiscard]] std::vector<RefusedDatagrams> refused() const;
  /// Address of the socket.
  [[nodiscard]] Address bound() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
