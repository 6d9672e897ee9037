#pragma once

#include <array>
#include <optional>

#include "tandem/plugin/udp_socket.h"

#include "coordination/src/wire/wire_handshake.h"
#include "net/session_keys.h"

namespace tandem::net {

/// The responder's half of a handshake, once the cookie was right.
class Answerer {
 public:
  Answerer(const Pair& pair, const SecretKey& key) noexcept : pair_(pair), key_(key) {}

  /// Answers OPEN with ACCEPT, and gives the keys that come into use when something opens under
  /// them. The same OPEN again gets the same answer, and no keys. Nothing is kept of one that does
  /// not open. An older one, which somebody has kept, gets none. Takes locked memory.
  [[nodiscard]] std::optional<SessionKeys> onOpen(const OpenMessage& message, const Address& from,
                                                  double now, Outlet& outlet,
                                                  Outcome& outcome) noexcept;

  /// The keys of the latest answer are gone without having been used: it is not given again.
  void forget() noexcept { has_newest_ = false; }

 private:
  [[nodiscard]] std::optional<SessionKeys> answer(const OpenMessage& message, double now,
                                                  Outcome& outcome);

  Pair pair_;
  const SecretKey& key_;
  /// Of the latest OPENs that were answered.
  struct Answered {
    std::uint64_t nonce = 0;
    NoiseMessage noise{};
  };
  static constexpr std::size_t kRemembered = 32;

  [[nodiscard]] bool isNewest(const OpenMessage& message) const noexcept;
  [[nodiscard]] bool isOld(const OpenMessage& message) const noexcept;

  std::array<Answered, kRemembered> answered_{};
  std::size_t answers_ = 0;
  bool has_newest_ = false;  ///< its keys are still there
  AcceptMessage accept_;
};

}  // namespace tandem::net
