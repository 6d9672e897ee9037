#pragma once

#include <array>
#include <cstdint>

#include <sodium.h>

#include "tandem/plugin/secret_key.h"

#include "secure/bytes.h"

namespace tandem::secure {

/// Shows that a clear datagram comes from somebody with the pair's key.
using Tag = std::array<std::uint8_t, 16>;

/// BLAKE2b-128 keyed by the pair's key, over the bytes before the tag. Pure; real-time safe.
[[nodiscard]] inline Tag computeTag(const SecretKey& key, ByteView covered) noexcept {
  Tag tag;
  crypto_generichash(tag.data(), tag.size(), covered.data(), covered.size(), key.data(),
                     SecretKey::kSize);
  return tag;
}

/// Compares in constant time.
[[nodiscard]] inline bool isTagged(const SecretKey& key, ByteView covered,
                                   const Tag& tag) noexcept {
  const Tag right = computeTag(key, covered);
  return sodium_memcmp(right.data(), tag.data(), tag.size()) == 0;
}

}  // namespace tandem::secure
