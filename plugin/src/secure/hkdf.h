#pragma once

#include <cstddef>

#include "secure/bytes.h"

namespace tandem::secure {

/// HASHLEN of BLAKE2b [bytes].
inline constexpr std::size_t kHashSize = 64;

/// HMAC-BLAKE2b (RFC 2104, block of 128 bytes) of two concatenated texts. `key` has up to 128
/// bytes, `out` kHashSize. Real-time safe.
void computeHmac(ByteView key, ByteView first, ByteView second, Bytes out) noexcept;

/// HKDF of the Noise specification (revision 34, section 4.3) with two or three outputs of
/// kHashSize bytes. `chaining_key` and `first` may be the same. Real-time safe.
void computeHkdf(ByteView chaining_key, ByteView input, Bytes first, Bytes second) noexcept;
void computeHkdf(ByteView chaining_key, ByteView input, Bytes first, Bytes second,
                 Bytes third) noexcept;

}  // namespace tandem::secure
