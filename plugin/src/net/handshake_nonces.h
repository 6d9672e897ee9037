#pragma once

#include <cstdint>
#include <optional>

#include "net/random.h"

namespace tandem::net {

/// The first nonce of a program that starts at this time since 1970 [s]: above all nonces of
/// programs that started a millisecond earlier.
[[nodiscard]] inline std::uint64_t drawFirstNonce(double utc) noexcept {
  constexpr int kDrawn = 20;  // bits
  const auto milliseconds = static_cast<std::uint64_t>(utc > 0.0 ? 1e3 * utc : 0.0);
  return milliseconds << kDrawn | (drawNumber<std::uint32_t>() & ((1U << kDrawn) - 1U));
}

/// Nonces of a site's handshakes, each above the one before.
class HandshakeNonces {
 public:
  explicit HandshakeNonces(std::uint64_t first) noexcept : last_(first) {}
  [[nodiscard]] std::uint64_t next() noexcept {
    return last_ += 1U + (drawNumber<std::uint32_t>() & 0xffU);
  }

 private:
  std::uint64_t last_;
};

/// Tells a peer's newest HELLO from recorded ones. Only the peer can make one with a higher nonce.
class NewestHello {
 public:
  enum class Age { kNew, kRepeated, kOld };
  /// Takes the nonce of an authentic HELLO.
  [[nodiscard]] Age note(std::uint64_t nonce) noexcept {
    if (newest_ && nonce <= *newest_) return nonce == *newest_ ? Age::kRepeated : Age::kOld;
    newest_ = nonce;
    return Age::kNew;
  }

 private:
  std::optional<std::uint64_t> newest_;
};

}  // namespace tandem::net
