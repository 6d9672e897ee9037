#pragma once

#include <sodium.h>

#include "coordination/src/wire/byte_writer.h"
#include "relay/admission_wire.h"
#include "secure/handshake_tag.h"

/// \file
/// Tags of a relay's datagrams. Those of the admission are under the relay's key, as in the
/// handshake of two sites. Those of a session are SipHash-2-4 under a key of that session alone.
/// Real-time safe.
namespace tandem::relay {

/// Writes the tag of an admission's datagram into its last bytes. Returns its size.
inline std::size_t tagLong(const SecretKey& key, ByteSpan datagram) noexcept {
  const std::size_t covered = datagram.size - kLongTag;
  const HandshakeTag tag = secure::computeTag(key, {datagram.data, covered});
  std::copy(tag.begin(), tag.end(), datagram.data + covered);
  return datagram.size;
}

[[nodiscard]] inline bool isTaggedLong(const SecretKey& key, ByteView datagram) noexcept {
  if (datagram.size < kLongTag) return false;
  const std::size_t covered = datagram.size - kLongTag;
  HandshakeTag tag;
  std::copy_n(datagram.data + covered, kLongTag, tag.begin());
  return secure::isTagged(key, {datagram.data, covered}, tag);
}

using SessionKey = std::array<std::uint8_t, crypto_shorthash_KEYBYTES>;

/// BLAKE2b-128 keyed by the relay's key, over "tandem relay", the session's number and what JOIN
/// says. Whoever has the relay's key and hears the admission can compute it.
[[nodiscard]] inline SessionKey computeSessionKey(const SecretKey& key, const Request& join,
                                                  std::uint32_t session) noexcept {
  constexpr std::string_view kLabel = "tandem relay";
  std::array<std::uint8_t, kLabel.size() + 4 + kHelloSize - kLongTag> text;
  wire::ByteWriter writer({text.data(), text.size()});
  writer.writeBytes(kLabel);
  writer.write(session);
  encodeRequest(Type::kJoin, join, {text.data() + writer.size(), text.size() - writer.size()});
  SessionKey session_key;
  crypto_generichash(session_key.data(), session_key.size(), text.data(), text.size(), key.data(),
                     SecretKey::kSize);
  return session_key;
}

using ShortTag = std::array<std::uint8_t, kShortTag>;
static_assert(crypto_shorthash_BYTES == kShortTag);

/// Writes the tag of a session's datagram into its last bytes. Returns its size.
inline std::size_t tagShort(const SessionKey& key, ByteSpan datagram) noexcept {
  const std::size_t covered = datagram.size - kShortTag;
  crypto_shorthash(datagram.data + covered, datagram.data, covered, key.data());
  return datagram.size;
}

[[nodiscard]] inline bool isTaggedShort(const SessionKey& key, ByteView datagram) noexcept {
  if (datagram.size < kShortTag) return false;
  const std::size_t covered = datagram.size - kShortTag;
  ShortTag right;
  crypto_shorthash(right.data(), datagram.data, covered, key.data());
  return sodium_memcmp(right.data(), datagram.data + covered, kShortTag) == 0;
}

}  // namespace tandem::relay
