#pragma once

#include <array>
#include <optional>

#include "tandem/plugin/udp_socket.h"

#include "coordination/src/wire/wire_handshake.h"
#include "net/session_keys.h"

namespace tandem::net {

/// The responder's half of a handshake, after the cookie was accepted.
class Answerer {
 public:
  Answerer(const Pair& pair, const SecretKey& key) noexcept : pair_(pair), key_(key) {}

  /// An OPEN of which this is a copy was answered last, or earlier, as in a replay.
  enum class Seen { kNever, kLast, kEarlier };
  [[nodiscard]] Seen find(const OpenMessage& message) const noexcept;

  /// Answers OPEN with ACCEPT and returns the new keys, which come into use when a datagram opens
  /// under them. The last one, repeated, gets the same answer and no keys. An OPEN that fails
  /// leaves no state. An earlier one gets no answer. Takes locked memory.
  [[nodiscard]] std::optional<SessionKeys> onOpen(const OpenMessage& message, const Address& from,
                                                  double now, Outlet& outlet,
                                                  Outcome& outcome) noexcept;

  /// Stops repeating the latest answer, because its keys expired unused.
  void forget() noexcept { has_newest_ = false; }

 private:
  [[nodiscard]] std::optional<SessionKeys> answer(const OpenMessage& message, double now,
                                                  Outcome& outcome);

  Pair pair_;
  const SecretKey& key_;
  /// One of the latest answered OPENs.
  struct Answered {
    std::uint64_t nonce = 0;
    NoiseMessage noise{};
  };
  static constexpr std::size_t kRemembered = 32;

  std::array<Answered, kRemembered> answered_{};
  std::size_t answers_ = 0;
  bool has_newest_ = false;  ///< the keys of the newest answer still exist
  AcceptMessage accept_;
};

}  // namespace tandem::net
