#pragma once

#include <array>
#include <cstddef>

#include "secure/bytes.h"
#include "secure/hkdf.h"

namespace tandem::secure {

inline constexpr std::size_t kKeySize = crypto_aead_chacha20poly1305_ietf_KEYBYTES;
inline constexpr std::size_t kTagSize = crypto_aead_chacha20poly1305_ietf_ABYTES;

/// Hashing and encryption of a Noise handshake: CipherState and SymmetricState of the specification
/// (revision 34, sections 5.1 and 5.2), with ChaChaPoly and BLAKE2b.
///
/// A plain secret value; keep it in locked memory. All functions are real-time safe.
struct SymmetricState {
  std::array<std::uint8_t, kHashSize> chaining_key;
  std::array<std::uint8_t, kHashSize> hash;
  std::array<std::uint8_t, kKeySize>
      key;  ///< of the next encryption; valid once something was mixed
  std::uint64_t nonce;

  /// `protocol_name` has up to kHashSize bytes.
  void start(ByteView protocol_name) noexcept;

  void mixHash(ByteView data) noexcept;
  void mixKey(ByteView input) noexcept;
  void mixKeyAndHash(ByteView input) noexcept;

  /// `sealed` has kTagSize bytes more than `text`; they must not overlap.
  void encryptAndHash(ByteView text, Bytes sealed) noexcept;

  /// Returns false if `sealed` was not made by encryptAndHash() in an equal state. `text` is then
  /// wiped and this state unusable. `text` has kTagSize bytes less than `sealed`.
  [[nodiscard]] bool decryptAndHash(ByteView sealed, Bytes text) noexcept;
};

}  // namespace tandem::secure
