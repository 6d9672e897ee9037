#pragma once

#include <optional>
#include <string>

#include "tandem/plugin/udp_mesh.h"

#include "net/agreement.h"
#include "net/answerer.h"
#include "net/caller.h"
#include "net/state_stream.h"

namespace tandem::net {

/// One pair's life: handshake, comparison of configurations, states, new keys, silence, farewell.
///
///   calling --keys--> agreeing --both equal--> live --5 s silence--> calling
///                        |                       |
///                    different (said why)        +--BYE--> left
///
/// In an outage the keys stay, so that the first datagram after it counts; the initiator calls
/// after a second of silence, in case that the peer has begun anew or has another address.
/// Time and bytes are passed in, so a test's network drives it as a socket does. Handling of states
/// never allocates; handshakes (at the start and every two minutes) and configurations do.
class PeerSession {
 public:
  /// What both sides of all pairs of a site have alike.
  struct Common {
    Configuration configuration;
    PlayoutSettings playout;
    WireProfile profile = WireProfile::kFloat32;
  };

  PeerSession(const Pair& pair, std::optional<Address> address, SecretKey key,
              const Common& common);
  PeerSession(const PeerSession&) = delete;
  PeerSession& operator=(const PeerSession&) = delete;

  /// Says what is due: handshakes, configuration, farewells. Drops keys that are too old.
  void advance(double now, Outlet& outlet) noexcept;

  // What came in, by type. Bytes may be changed.
  [[nodiscard]] Outcome onCookie(ByteView datagram, double now) noexcept;
  [[nodiscard]] Outcome onAccept(ByteView datagram, const Address& from, double now) noexcept;
  [[nodiscard]] Outcome onRefuse(ByteView datagram) noexcept;
  /// The cookie was right.
  [[nodiscard]] Outcome onOpen(const OpenMessage& message, const Address& from, double now,
                               Outlet& outlet) noexcept;
  [[nodiscard]] Outcome onSealed(const ClearHeader& header, ByteSpan datagram, const Address& from,
                                 double now, Outlet& outlet) noexcept;

  /// Sends a state if there is somebody to send it to.
  void send(const StatePacket& packet, double now, Outlet& outlet) noexcept;
  [[nodiscard]] std::optional<Arrival> pop(double from, double until) noexcept {
    return stream_.pop(from, until);
  }

  /// Says farewell ten times, one every ten milliseconds.
  void leave(ByeReason reason, double now) noexcept;

  [[nodiscard]] PeerStatus status(double now) const;
  /// Whether this is where the peer is, as far as we know.
  [[nodiscard]] bool knows(const Address& address) const noexcept {
    return address_ == address || configured_ == address;
  }
  [[nodiscard]] const Pair& pair() const noexcept { return pair_; }

 private:
  [[nodiscard]] Outcome handle(MessageType type, std::optional<std::uint64_t> sequence,
                               ByteView payload, double now, Outlet& outlet);
  void install(SessionKeys keys, double now) noexcept;
  /// False if the key is used up or it is not known where the peer is.
  bool sendSealed(MessageType type, std::size_t payload_size, ByteSpan datagram,
                  Outlet& outlet) noexcept;
  void callIfNeeded(double now, Outlet& outlet) noexcept;
  void tellConfiguration(double now, Outlet& outlet) noexcept;
  void sayBye(double now, Outlet& outlet) noexcept;
  void dropOldKeys(double now) noexcept;
  void forgetKeys() noexcept;

  Pair pair_;
  std::optional<Address> address_;           ///< where it was heard from last
  const std::optional<Address> configured_;  ///< that was given
  SecretKey key_;
  Caller caller_;
  Answerer answerer_;
  Agreement agreement_;
  StateStream stream_;

  std::optional<SessionKeys> keys_;      ///< sealed with
  std::optional<SessionKeys> coming_;    ///< responder's: until something opens under them
  std::optional<SessionKeys> previous_;  ///< open what is still on its way
  double previous_until_ = 0.0;
  std::uint16_t epoch_ = 0;

  double heard_at_ = 0.0;  ///< under the present keys, or until then under those before
  bool has_heard_present_ = false;
  std::uint64_t newest_sequence_ = 0;
  double agree_at_ = 0.0;
  std::optional<ByeReason> bye_reason_;  ///< ours
  int byes_left_ = 0;
  double bye_at_ = 0.0;
  std::optional<ByeReason> left_;  ///< the peer's
  std::uint64_t states_sent_ = 0, states_unsent_ = 0;
};

}  // namespace tandem::net
