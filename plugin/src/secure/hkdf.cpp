#include "secure/hkdf.h"

#include <algorithm>

namespace tandem::secure {
namespace {

constexpr std::size_t kBlockSize = 128;

/// BLAKE2b-512 over several pieces. Wiped at its end, because under HMAC its state equals the key.
class Hash {
 public:
  Hash() noexcept { crypto_generichash_init(&state_, nullptr, 0, kHashSize); }
  ~Hash() { sodium_memzero(&state_, sizeof state_); }
  Hash(const Hash&) = delete;
  Hash& operator=(const Hash&) = delete;

  Hash& add(ByteView piece) noexcept {
    crypto_generichash_update(&state_, piece.data(), piece.size());
    return *this;
  }
  void finish(Bytes out) noexcept { crypto_generichash_final(&state_, out.data(), kHashSize); }

 private:
  crypto_generichash_state state_;
};

/// The key, padded with zeros, XOR `value`.
struct Pad : WipedBytes<kBlockSize> {
  Pad(ByteView key, std::uint8_t value) noexcept {
    std::copy(key.begin(), key.end(), begin());
    for (std::uint8_t& byte : *this) byte ^= value;
  }
};

/// Computes one output of HKDF: HMAC(key, previous || number).
void computeOutput(ByteView key, ByteView previous, std::uint8_t number, Bytes out) noexcept {
  computeHmac(key, previous, ByteView(&number, 1), out);
}

}  // namespace

void computeHmac(ByteView key, ByteView first, ByteView second, Bytes out) noexcept {
  WipedBytes<kHashSize> inner;
  Hash().add(Pad(key, 0x36)).add(first).add(second).finish(inner);
  Hash().add(Pad(key, 0x5c)).add(inner).finish(out);
}

void computeHkdf(ByteView chaining_key, ByteView input, Bytes first, Bytes second) noexcept {
  WipedBytes<kHashSize> key;
  computeHmac(chaining_key, input, {}, key);
  computeOutput(key, {}, 1, first);
  computeOutput(key, first, 2, second);
}

void computeHkdf(ByteView chaining_key, ByteView input, Bytes first, Bytes second,
                 Bytes third) noexcept {
  WipedBytes<kHashSize> key;
  computeHmac(chaining_key, input, {}, key);
  computeOutput(key, {}, 1, first);
  computeOutput(key, first, 2, second);
  computeOutput(key, second, 3, third);
}

}  // namespace tandem::secure
