#pragma once

#include <optional>

#include "tandem/plugin/udp_socket.h"

#include "coordination/src/wire/wire_handshake.h"
#include "net/handshake_nonces.h"
#include "net/paths.h"
#include "net/retry.h"
#include "net/session_keys.h"

namespace tandem::net {

/// The initiator's half of a handshake: HELLO until a cookie comes, OPEN until the peer accepts.
class Caller {
 public:
  /// `first_nonce` is above the nonces of all earlier programs at this site.
  Caller(const Pair& pair, const SecretKey& key, std::uint64_t first_nonce) noexcept
      : pair_(pair), key_(key), nonces_(first_nonce) {}

  /// Starts a handshake for this key epoch.
  void start(std::uint16_t epoch, double now) noexcept;
  void stop() noexcept;
  [[nodiscard]] bool isActive() const noexcept { return stage_ != Stage::kIdle; }

  /// Repeats the unanswered message, to all these addresses.
  void advance(double now, const Paths::Calls& to, Outlet& outlet) noexcept;

  /// Sends the unanswered message to one more address.
  void callAt(const Address& to, Outlet& outlet) const noexcept;

  [[nodiscard]] Outcome onCookie(ByteView datagram, double now) noexcept;
  /// Returns the new keys. Returns nothing, with the reason in `outcome`, if this does not answer
  /// our OPEN. Takes locked memory.
  [[nodiscard]] std::optional<SessionKeys> onAccept(ByteView datagram, double now,
                                                    Outcome& outcome) noexcept;
  /// Stores the refusal for the user. Asks for a new cookie if the cookie was wrong.
  [[nodiscard]] Outcome onRefuse(ByteView datagram) noexcept;

  /// Time from the first OPEN to the last ACCEPT, at least a round trip and at most 5 s [s].
  [[nodiscard]] double took() const noexcept { return took_; }

  /// Latest refusal of the other side until a handshake succeeds; not authentic.
  [[nodiscard]] const std::optional<RefuseMessage>& refused() const noexcept { return refused_; }

 private:
  enum class Stage { kIdle, kHello, kOpen };

  [[nodiscard]] Outcome writeOpen(const CookieBytes& cookie) noexcept;
  [[nodiscard]] bool isAnswer(const HandshakeRoute& route) const noexcept;

  Pair pair_;
  const SecretKey& key_;
  Stage stage_ = Stage::kIdle;
  Retry retry_;
  double opened_at_ = 0.0, took_ = 0.0;
  HandshakeNonces nonces_;
  std::uint64_t nonce_ = 0;
  std::uint16_t epoch_ = 0;
  std::uint32_t session_ = 0;  ///< our session number
  std::optional<secure::Initiator> noise_;
  OpenMessage open_;
  std::optional<RefuseMessage> refused_;
};

}  // namespace tandem::net
