#pragma once

#include <cstddef>
#include <cstdint>

#include "tandem/plugin/secret_key.h"

#include "secure/bytes.h"
#include "secure/symmetric_state.h"

/// \file
/// Sealed datagrams of one direction under one key: ChaCha20-Poly1305-IETF in place. The nonce
/// combines a salt and a sequence number. Real-time safe except for construction.
namespace tandem::secure {

/// Most datagrams that are sealed under one key.
inline constexpr std::uint64_t kSealLimit = std::uint64_t{1} << 32;

/// Seals datagrams. It owns the increasing sequence number, so no nonce is used twice under a key,
/// if no other Sealer has that key. It can be moved; a moved-from Sealer seals nothing.
class Sealer {
 public:
  Sealer(SecretKey key, std::uint32_t salt, std::uint64_t limit = kSealLimit) noexcept;

  /// Sequence number of the next datagram, from 0. The header carries it in the clear.
  [[nodiscard]] std::uint64_t nextSequence() const noexcept { return next_; }

  /// Seals `datagram` in place except its last kTagSize bytes, which receive the tag. Binds it to
  /// `associated`, which must not overlap. Returns false and changes nothing if the limit is
  /// reached, there is no room for the tag, or no key.
  [[nodiscard]] bool seal(ByteView associated, Bytes datagram) noexcept;

 private:
  SecretKey key_;
  std::uint32_t salt_;
  std::uint64_t limit_;
  std::uint64_t next_ = 0;
};

/// Opens datagrams sealed with the same key and salt. It keeps no state: a window of sequence
/// numbers detects replays.
class Opener {
 public:
  Opener(SecretKey key, std::uint32_t salt) noexcept;

  /// Opens `datagram` in place; its last kTagSize bytes are the tag. Returns false if key, salt,
  /// sequence, `associated` or any byte is wrong. `datagram` is then unchanged or wiped.
  [[nodiscard]] bool open(std::uint64_t sequence, ByteView associated,
                          Bytes datagram) const noexcept;

 private:
  SecretKey key_;
  std::uint32_t salt_;
};

}  // namespace tandem::secure
