#pragma once

#include <optional>

#include "tandem/plugin/udp_socket.h"

#include "coordination/src/wire/wire_handshake.h"
#include "net/retry.h"
#include "net/session_keys.h"

namespace tandem::net {

/// The initiator's half of a handshake: HELLO until a cookie comes, OPEN until the other accepts.
class Caller {
 public:
  Caller(const Pair& pair, const SecretKey& key) noexcept : pair_(pair), key_(key) {}

  /// Begins anew, with this epoch.
  void start(std::uint16_t epoch, double now) noexcept;
  void stop() noexcept;
  [[nodiscard]] bool isActive() const noexcept { return stage_ != Stage::kIdle; }

  /// Says again what was not answered, to both addresses.
  void advance(double now, const Address& to, const std::optional<Address>& also,
               Outlet& outlet) noexcept;

  [[nodiscard]] Outcome onCookie(ByteView datagram, double now) noexcept;
  /// The new keys; nothing, and `outcome` says why, if this is no answer to our OPEN. Takes locked
  /// memory.
  [[nodiscard]] std::optional<SessionKeys> onAccept(ByteView datagram, double now,
                                                    Outcome& outcome) noexcept;
  /// Remembered for the user; for a wrong cookie another is asked for.
  [[nodiscard]] Outcome onRefuse(ByteView datagram) noexcept;

  /// How long the first OPEN waited for the last ACCEPT, at least a round trip; or 5 s [s].
  [[nodiscard]] double took() const noexcept { return took_; }

  /// What the other side refused with last, if it did since start(); not authentic.
  [[nodiscard]] const std::optional<RefuseMessage>& refused() const noexcept { return refused_; }

 private:
  enum class Stage { kIdle, kHello, kOpen };

  [[nodiscard]] Outcome writeOpen() noexcept;
  [[nodiscard]] bool isAnswer(const HandshakeRoute& route) const noexcept;

  Pair pair_;
  const SecretKey& key_;
  Stage stage_ = Stage::kIdle;
  Retry retry_;
  double opened_at_ = 0.0, took_ = 0.0;
  std::uint64_t nonce_ = 0;
  std::uint16_t epoch_ = 0;
  std::uint32_t session_ = 0;  ///< ours
  std::optional<secure::Initiator> noise_;
  OpenMessage open_;
  std::optional<RefuseMessage> refused_;
};

}  // namespace tandem::net
