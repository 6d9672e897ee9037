#include "secure/seal.h"

#include <utility>

#include "coordination/src/wire/wire_sealing.h"

namespace tandem::secure {

Sealer::Sealer(SecretKey key, std::uint32_t salt, std::uint64_t limit) noexcept
    : key_(std::move(key)), salt_(salt), limit_(limit) {}

bool Sealer::seal(ByteView associated, Bytes datagram) noexcept {
  if (key_.isEmpty() || next_ >= limit_ || datagram.size() < kTagSize) return false;
  const std::size_t size = datagram.size() - kTagSize;
  crypto_aead_chacha20poly1305_ietf_encrypt_detached(
      datagram.data(), datagram.data() + size, nullptr, datagram.data(), size, associated.data(),
      associated.size(), nullptr, writeNonce(salt_, next_).data(), key_.data());
  ++next_;
  return true;
}

Opener::Opener(SecretKey key, std::uint32_t salt) noexcept : key_(std::move(key)), salt_(salt) {}

bool Opener::open(std::uint64_t sequence, ByteView associated, Bytes datagram) const noexcept {
  if (key_.isEmpty() || datagram.size() < kTagSize) return false;
  const std::size_t size = datagram.size() - kTagSize;
  return crypto_aead_chacha20poly1305_ietf_decrypt_detached(
             datagram.data(), nullptr, datagram.data(), size, datagram.data() + size,
             associated.data(), associated.size(), writeNonce(salt_, sequence).data(),
             key_.data()) == 0;
}

}  // namespace tandem::secure
