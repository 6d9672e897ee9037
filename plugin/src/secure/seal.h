#pragma once

#include <cstddef>
#include <cstdint>

#include "tandem/plugin/secret_key.h"

#include "secure/bytes.h"
#include "secure/symmetric_state.h"

/// \file
/// Sealed datagrams of one direction under one key: ChaCha20-Poly1305-IETF in place, the nonce made
/// of a salt and a sequence number. All but construction is real-time safe.
namespace tandem::secure {

/// So many datagrams are sealed under one key at most.
inline constexpr std::uint64_t kSealLimit = std::uint64_t{1} << 32;

/// Seals. It owns the sequence number, which only goes up: no nonce is used twice under its key, as
/// long as no other Sealer is made from the same key. Moves, and what it was moved from seals
/// nothing.
class Sealer {
 public:
  Sealer(SecretKey key, std::uint32_t salt, std::uint64_t limit = kSealLimit) noexcept;

  /// The sequence number of the next datagram, from 0: it goes into the header in the clear.
  [[nodiscard]] std::uint64_t nextSequence() const noexcept { return next_; }

  /// Seals the text in all of `datagram` but its last kTagSize bytes, where the tag goes, and binds
  /// it to `associated`, which must not overlap. False, and nothing is changed, when the limit is
  /// reached, when there is no room for the tag, or when there is no key.
  [[nodiscard]] bool seal(ByteView associated, Bytes datagram) noexcept;

 private:
  SecretKey key_;
  std::uint32_t salt_;
  std::uint64_t limit_;
  std::uint64_t next_ = 0;
};

/// Opens what the Sealer of the same key and salt has sealed. It remembers nothing: replays are the
/// business of a window of sequence numbers.
class Opener {
 public:
  Opener(SecretKey key, std::uint32_t salt) noexcept;

  /// Opens `datagram`, sealed text and tag, in place: the text is all but the last kTagSize bytes.
  /// False if key, salt, sequence, `associated` or any byte is not what was sealed; then `datagram`
  /// holds no text: it is as it was, or wiped.
  [[nodiscard]] bool open(std::uint64_t sequence, ByteView associated,
                          Bytes datagram) const noexcept;

 private:
  SecretKey key_;
  std::uint32_t salt_;
};

}  // namespace tandem::secure
