#pragma once

#include <sodium.h>

#include "tandem/plugin/secret_key.h"

#include "coordination/src/wire/wire_handshake.h"
#include "secure/bytes.h"

/// \file
/// Tags of clear datagrams show that the sender has the pair's key.
namespace tandem::secure {

/// BLAKE2b-128 keyed by the pair's key, over the bytes before the tag. Pure; real-time safe.
[[nodiscard]] inline HandshakeTag computeTag(const SecretKey& key, ByteView covered) noexcept {
  HandshakeTag tag;
  crypto_generichash(tag.data(), tag.size(), covered.data(), covered.size(), key.data(),
                     SecretKey::kSize);
  return tag;
}

/// Compares in constant time.
[[nodiscard]] inline bool isTagged(const SecretKey& key, ByteView covered,
                                   const HandshakeTag& tag) noexcept {
  const HandshakeTag right = computeTag(key, covered);
  return sodium_memcmp(right.data(), tag.data(), tag.size()) == 0;
}

}  // namespace tandem::secure
