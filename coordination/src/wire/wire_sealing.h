#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "wire/wire.h"
#include "wire/wire_handshake.h"

/// \file
/// Bytes that enter Noise and sealing besides keys and payload (sections 4 and 5).
#pragma GCC visibility push(default)
namespace tandem {

using NoisePrologue = std::array<std::uint8_t, 29>;
using SessionTermsBytes = std::array<std::uint8_t, 8>;
using AssociatedData = std::array<std::uint8_t, 32>;
using SealNonce = std::array<std::uint8_t, 12>;

/// Highest minor version that is spoken here.
inline constexpr std::uint8_t kMinorVersion = 2;

/// Terms that each side sends inside its Noise message.
struct SessionTerms {
  std::uint32_t session = 0;    ///< session id under which the sender wants to be addressed; not 0
  std::uint16_t key_epoch = 0;  ///< chosen by the initiator, repeated by the responder; not 0
  std::uint8_t minor = 0;       ///< highest minor version spoken; the answer has the lower of both
};

/// Prologue of the pair's handshake; the initiator has the lower id. With the responder's cookie in
/// it, a recorded message 1 opens for no other cookie.
[[nodiscard]] NoisePrologue writeNoisePrologue(PeerId initiator, PeerId responder,
                                               const CookieBytes& cookie) noexcept;

[[nodiscard]] SessionTermsBytes writeSessionTerms(const SessionTerms& terms) noexcept;
[[nodiscard]] Decoded<SessionTerms> readSessionTerms(const SessionTermsBytes& bytes) noexcept;

/// Associated data of a sealed datagram: its first kHeaderSize bytes on the wire, then the peers'
/// ids in the datagram's direction.
[[nodiscard]] AssociatedData writeAssociatedData(const std::uint8_t* header, PeerId from,
                                                 PeerId to) noexcept;

/// The part of the nonce that is constant for one direction and key epoch.
[[nodiscard]] constexpr std::uint32_t computeNonceSalt(PeerId sender,
                                                       std::uint16_t key_epoch) noexcept {
  return (static_cast<std::uint32_t>(sender) & 0xffffU) | std::uint32_t{key_epoch} << 16;
}

/// Salt, then sequence. With salt 0 this is the nonce of Noise's ChaChaPoly (revision 34, section
/// 12.3).
[[nodiscard]] SealNonce writeNonce(std::uint32_t salt, std::uint64_t sequence) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
