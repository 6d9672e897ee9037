#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tandem::relay {

/// The fate of a received datagram.
enum class Result : std::uint8_t {
  kTaken,       ///< answered or forwarded
  kForm,        ///< no datagram of a relay
  kKey,         ///< the admission is not tagged under the relay's key
  kCookie,      ///< wrong or expired cookie
  kOld,         ///< JOIN of an earlier attempt
  kFull,        ///< no room or no place in the room
  kIdInUse,     ///< a live member has the id
  kSession,     ///< unknown session
  kReplayed,    ///< received before, or too far behind
  kForged,      ///< not tagged under the session's key
  kTooMany,     ///< beyond the member's rate
  kNoReceiver,  ///< the receiver is not in the room
  kWatcher      ///< a watcher says something
};
inline constexpr std::size_t kResults = static_cast<std::size_t>(Result::kWatcher) + 1;

[[nodiscard]] const char* name(Result result) noexcept;

struct RelayCounts {
  std::array<std::uint64_t, kResults> results{};
  std::uint64_t forwarded = 0, forwarded_bytes = 0;

  [[nodiscard]] std::uint64_t of(Result result) const noexcept {
    return results[static_cast<std::size_t>(result)];
  }
};

}  // namespace tandem::relay
