#pragma once

#include <cstdint>
#include <optional>

#include "tandem/coordination/types.h"
#include "tandem/plugin/udp_socket.h"

#include "net/handshake_nonces.h"
#include "net/retry.h"
#include "relay/relay_tags.h"
#include "relay/session_wire.h"

namespace tandem::relay {

/// A site's membership in a room of a relay. As an Outlet it sends datagrams to relayed addresses
/// through the relay, and all others directly.
///
///   HELLO --cookie--> JOIN --joined--> KEEP once a second --3 s without an answer--> HELLO
///
/// The old session goes on until there is a new one. Time and bytes come from the caller. Real-time
/// safe but for construction.
class RelayMember final : public net::Outlet {
 public:
  /// `first_nonce` is above the nonces of all earlier programs at this site. `socket` must outlive
  /// this. Throws std::invalid_argument for an id above 64.
  RelayMember(const Address& relay, SecretKey key, const RoomName& room, PeerId self,
              std::uint64_t first_nonce, net::Outlet& socket, bool is_watcher = false);

  void send(ByteView datagram, const Address& to) noexcept override;

  /// Sends what is due.
  void advance(double now) noexcept;

  /// Takes a datagram from the relay's address. Returns what a member said, in place, with the
  /// member's number.
  [[nodiscard]] std::optional<Forwarded> receive(ByteSpan datagram, double now) noexcept;

  /// True if the relay says that another live member has this id; not authentic.
  [[nodiscard]] bool isIdTaken() const noexcept {
    return !isIn() && refused_ && refused_->code == Code::kTaken;
  }
  /// Asks for the room as another member, 1 to 64, once it is not in it.
  void callAs(PeerId self) noexcept;

  /// Says farewell; several copies, as one may be lost. A later advance() joins again.
  void leave() noexcept;

  [[nodiscard]] const Address& relay() const noexcept { return relay_; }
  [[nodiscard]] bool isIn() const noexcept { return session_ != 0; }
  /// Time since the last answer of the relay [s]; 0 while it is not in a room.
  [[nodiscard]] double silence(double now) const noexcept { return isIn() ? now - heard_at_ : 0.0; }
  /// Smoothed, to the relay and back [s]; 0: not measured yet.
  [[nodiscard]] double roundTrip() const noexcept { return round_trip_; }
  /// Reason why the relay does not let this site in; not authentic.
  [[nodiscard]] const std::optional<RefuseAnswer>& refused() const noexcept { return refused_; }

  /// A member's address as the relay sees it.
  struct Seen {
    PeerId member{};
    Address address;
  };
  /// The newest one; each is given once.
  [[nodiscard]] std::optional<Seen> takeSeen() noexcept;

 private:
  enum class Stage { kIdle, kHello, kJoin };

  void startAttempt(double now) noexcept;
  void sendRequest() noexcept;
  void sendKeep(double now) noexcept;
  void sendTagged(ByteSpan datagram) noexcept;
  [[nodiscard]] std::uint16_t nextAsked() noexcept;
  void onCookie(ByteView datagram, double now) noexcept;
  void onJoined(ByteView datagram, double now) noexcept;
  void onRefuse(ByteView datagram, double now) noexcept;
  void onKept(ByteView datagram, double now) noexcept;
  void onChallenge(ByteView datagram) noexcept;
  [[nodiscard]] bool isOfSession(ByteView datagram) const noexcept;

  Address relay_;
  SecretKey key_;
  net::Outlet& socket_;

  Stage stage_ = Stage::kIdle;
  Request request_;
  net::HandshakeNonces nonces_;
  net::Retry retry_;
  double joining_since_ = 0.0, next_attempt_ = 0.0;  // [s]
  std::optional<RefuseAnswer> refused_;

  std::uint32_t session_ = 0;  ///< 0: none
  SessionKey session_key_{};
  std::uint64_t next_sequence_ = 0;
  double joined_at_ = 0.0, heard_at_ = 0.0, next_keep_ = 0.0;  // [s]
  SessionHead keep_;                                           ///< the last one
  std::uint64_t next_kept_ = 0;                                ///< answers below are old
  double kept_since_ = 0.0, round_trip_ = 0.0;                 // [s]
  std::uint64_t members_ = 0;
  std::uint16_t asked_ = 0;
  std::optional<Seen> seen_;
};

}  // namespace tandem::relay
