#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "coordination/src/wire/wire.h"

namespace tandem::net {

/// Reasons to drop a datagram, besides a wrong form (WireRefusal).
enum class Refusal : std::uint8_t {
  kNone,
  kForm,            ///< see DatagramCounts::form
  kNotForMe,        ///< another receiver, or a sender that is no peer of this site
  kOutOfTurn,       ///< an answer without a question
  kTooMany,         ///< above the rate limit of handshakes
  kCookie,          ///< wrong or expired cookie
  kKey,             ///< the Noise message does not open: another pre-shared key
  kUnknownSession,  ///< no key for this session, sender and epoch
  kExpired,         ///< the key is too old
  kReplayed,        ///< received before, or too far behind
  kForged,          ///< fails authentication
  kNotAgreed,       ///< state before the configurations agree, or of another one
  kAfterBye,
};
inline constexpr std::size_t kRefusals = static_cast<std::size_t>(Refusal::kAfterBye) + 1;

/// Counts of received datagrams by result.
struct DatagramCounts {
  std::uint64_t received = 0;
  std::uint64_t taken = 0;
  std::array<std::uint64_t, kRefusals> refused{};
  std::array<std::uint64_t, kWireRefusals> form{};  ///< parts of refused[kForm]

  [[nodiscard]] std::uint64_t of(Refusal refusal) const noexcept {
    return refused[static_cast<std::size_t>(refusal)];
  }
  [[nodiscard]] std::uint64_t of(WireRefusal refusal) const noexcept {
    return form[static_cast<std::size_t>(refusal)];
  }
  void add(Refusal refusal) noexcept {
    ++received;
    if (refusal == Refusal::kNone)
      ++taken;
    else
      ++refused[static_cast<std::size_t>(refusal)];
  }
};

/// Result of handling a datagram.
struct Outcome {
  Refusal refusal = Refusal::kNone;
  WireRefusal form = WireRefusal::kNone;

  Outcome() noexcept = default;
  Outcome(Refusal why) noexcept : refusal(why) {}  // NOLINT: `return Refusal::kForged;`
  Outcome(WireRefusal why) noexcept                // NOLINT
      : refusal(Refusal::kForm), form(why) {}
};

}  // namespace tandem::net
