#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "coordination/src/wire/wire.h"

namespace tandem::net {

/// Why a datagram was dropped, besides not being of the standard's form (WireRefusal).
enum class Refusal : std::uint8_t {
  kNone,
  kForm,            ///< see DatagramCounts::form
  kNotForMe,        ///< another receiver, or a sender that is no peer of this site
  kOutOfTurn,       ///< an answer to nothing that was asked
  kTooMany,         ///< more handshakes than are answered in a second
  kCookie,          ///< wrong or too old
  kKey,             ///< Noise message does not open: another pre-shared key
  kUnknownSession,  ///< no key of this session, sender and epoch
  kExpired,         ///< key older than it may be
  kReplayed,        ///< taken before, or too far behind
  kForged,          ///< does not open
  kNotAgreed,       ///< a state before both configurations were compared, or of another one
  kAfterBye,
};
inline constexpr std::size_t kRefusals = static_cast<std::size_t>(Refusal::kAfterBye) + 1;

/// Datagrams that came in, by what became of them.
struct DatagramCounts {
  std::uint64_t received = 0;
  std::uint64_t taken = 0;
  std::array<std::uint64_t, kRefusals> refused{};
  std::array<std::uint64_t, kWireRefusals> form{};  ///< of refused[kForm]

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

/// What handling a datagram came to.
struct Outcome {
  Refusal refusal = Refusal::kNone;
  WireRefusal form = WireRefusal::kNone;

  Outcome() noexcept = default;
  Outcome(Refusal why) noexcept : refusal(why) {}  // NOLINT: `return Refusal::kForged;`
  Outcome(WireRefusal why) noexcept                // NOLINT
      : refusal(Refusal::kForm), form(why) {}
};

}  // namespace tandem::net
