#pragma once

#include <array>
#include <cstdint>

#include "secure/bytes.h"

namespace tandem::secure {

/// Nonce of ChaCha20-Poly1305-IETF: salt, then sequence, both little-endian. With salt 0 it is the
/// one of Noise's ChaChaPoly (revision 34, section 12.3).
[[nodiscard]] constexpr std::array<std::uint8_t, 12> makeNonce(std::uint32_t salt,
                                                               std::uint64_t sequence) noexcept {
  std::array<std::uint8_t, 12> nonce{};
  putLittleEndian(putLittleEndian(nonce.data(), salt), sequence);
  return nonce;
}

}  // namespace tandem::secure
