#pragma once

#include <optional>
#include <string>

#include "tandem/plugin/udp_mesh.h"

#include "net/agreement.h"
#include "net/answerer.h"
#include "net/caller.h"
#include "net/paths.h"
#include "net/state_stream.h"

namespace tandem::net {

/// Connection of one pair: handshake, comparison of configurations, states, new keys, silence,
/// farewell.
///
///   calling --keys--> agreeing --both equal--> live --5 s silence--> calling
///                        |                       |
///                    different (said why)        +--BYE--> left
///
/// The keys survive an outage, so the first datagram after it counts. The initiator calls after one
/// second of silence, because the peer may have restarted or moved. The caller passes time and
/// bytes, so a test's network works like a socket. States never allocate. Handshakes (at the start
/// and every two minutes) and configurations do.
class PeerSession {
 public:
  /// Settings common to all pairs of a site.
  struct Common {
    Configuration configuration;
    PlayoutSettings playout;
    WireProfile profile = WireProfile::kFloat32;
    std::uint64_t first_nonce = 0;  ///< drawFirstNonce() of the program's start
  };

  /// `relayed`: the address that means "through the relay"; empty without a relay.
  PeerSession(const Pair& pair, const std::optional<Address>& address,
              const std::optional<Address>& relayed, SecretKey key, const Common& common);
  PeerSession(const PeerSession&) = delete;
  PeerSession& operator=(const PeerSession&) = delete;

  /// Sends due handshakes, configurations and farewells. Drops expired keys.
  void advance(double now, Outlet& outlet) noexcept;

  // Handlers of received datagrams, by type. They may change the bytes.
  /// Age of an authentic HELLO with this nonce.
  [[nodiscard]] NewestHello::Age noteHello(std::uint64_t nonce) noexcept {
    return newest_hello_.note(nonce);
  }
  /// A responder asks to be called at this address.
  void onKnock(const Address& from, Outlet& outlet) noexcept { caller_.callAt(from, outlet); }
  [[nodiscard]] Outcome onCookie(ByteView datagram, double now) noexcept;
  [[nodiscard]] Outcome onAccept(ByteView datagram, const Address& from, double now) noexcept;
  [[nodiscard]] Outcome onRefuse(ByteView datagram) noexcept;
  /// Whether this OPEN was answered already.
  [[nodiscard]] Answerer::Seen findOpen(const OpenMessage& message) const noexcept {
    return answerer_.find(message);
  }
  /// Called after tag and cookie were accepted.
  [[nodiscard]] Outcome onOpen(const OpenMessage& message, const Address& from, double now,
                               Outlet& outlet) noexcept;
  [[nodiscard]] Outcome onSealed(const ClearHeader& header, ByteSpan datagram, const Address& from,
                                 double now, Outlet& outlet) noexcept;

  /// Sends a state if the peer's keys and address are known.
  void send(const StatePacket& packet, double now, Outlet& outlet) noexcept;
  [[nodiscard]] std::optional<Arrival> pop(double from, double until) noexcept {
    return stream_.pop(from, until);
  }

  /// Somebody who is trusted with nothing else tells that the peer may be there.
  void hearOf(const Address& address) noexcept { paths_.hear(address); }

  /// Sends farewell ten times, every 10 ms.
  void leave(ByeReason reason, double now) noexcept;

  /// True from the peer's farewell until its next keys.
  [[nodiscard]] bool hasLeft() const noexcept { return left_.has_value(); }
  [[nodiscard]] PeerStatus status(double now) const;
  /// True for the peer's configured address and the one last heard from.
  [[nodiscard]] bool knows(const Address& address) const noexcept { return paths_.knows(address); }
  [[nodiscard]] const Pair& pair() const noexcept { return pair_; }
  /// The key that the pair shares.
  [[nodiscard]] const SecretKey& key() const noexcept { return key_; }
  /// Somebody calls in the peer's name with another key. Not authentic.
  void noteForeignKey() noexcept { is_called_with_another_key_ = true; }

 private:
  [[nodiscard]] Outcome handle(MessageType type, std::optional<std::uint64_t> sequence,
                               ByteView payload, const Address& from, double now, Outlet& outlet);
  void install(SessionKeys keys, double now) noexcept;
  /// Returns the size; 0 if the key is used up or the peer's address is unknown.
  std::size_t sendSealed(MessageType type, std::size_t payload_size, ByteSpan datagram,
                         Outlet& outlet) noexcept;
  /// The same to any address.
  std::size_t sendSealedTo(const Address& to, MessageType type, std::size_t payload_size,
                           ByteSpan datagram, Outlet& outlet) noexcept;
  void checkPaths(double now, Outlet& outlet) noexcept;
  void answerChallenge(PathToken token, const Address& from, Outlet& outlet) noexcept;
  void callIfNeeded(double now, Outlet& outlet) noexcept;
  void knockIfNeeded(double now, Outlet& outlet) noexcept;
  void tellConfiguration(double now, Outlet& outlet) noexcept;
  void sayBye(double now, Outlet& outlet) noexcept;
  void dropOldKeys(double now) noexcept;
  void forgetKeys() noexcept;

  Pair pair_;
  Paths paths_;
  SecretKey key_;
  Caller caller_;
  HandshakeNonces knock_nonces_;
  Retry knocks_;
  std::uint64_t knock_nonce_ = 0;  ///< of a responder that nobody calls; else 0
  Answerer answerer_;
  NewestHello newest_hello_;
  Agreement agreement_;
  StateStream stream_;

  std::optional<SessionKeys> keys_;      ///< present keys, used for sealing
  std::optional<SessionKeys> coming_;    ///< of a responder, until a datagram opens under them
  std::optional<SessionKeys> previous_;  ///< open datagrams that are still under way
  double previous_until_ = 0.0;
  std::uint16_t epoch_ = 0;

  /// Last datagram under the present keys, or their begin. One under the previous keys shows that
  /// the peer is there, but not that it has the present ones.
  double heard_at_ = 0.0;
  bool has_heard_present_ = false;
  std::uint64_t newest_sequence_ = 0;
  double agree_at_ = 0.0;
  std::optional<ByeReason> bye_reason_;  ///< our reason
  int byes_left_ = 0;
  double bye_at_ = 0.0;
  std::optional<ByeReason> left_;  ///< the peer's reason
  std::uint64_t states_sent_ = 0, states_unsent_ = 0;
  bool is_called_with_another_key_ = false;  ///< since the last handshake
};

}  // namespace tandem::net
