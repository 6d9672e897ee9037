#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "wire/wire.h"

/// \file
/// The clear datagrams of the handshake (section 4), whole, with their header. What Noise puts into
/// its messages and the cookie's making are the caller's.
#pragma GCC visibility push(default)
namespace tandem {

inline constexpr std::size_t kHelloSize = 256;  ///< [bytes], as all of these with header
inline constexpr std::size_t kCookieSize = 48;
inline constexpr std::size_t kOpenSize = 104;
inline constexpr std::size_t kAcceptSize = 88;
inline constexpr std::size_t kRefuseSize = 32;

using CookieBytes = std::array<std::uint8_t, 16>;
using NoiseMessage = std::array<std::uint8_t, 56>;  ///< key 32, sealed terms 8, tag 16

/// From whom to whom, in which try.
struct HandshakeRoute {
  PeerId sender{};
  PeerId receiver{};
  std::uint64_t nonce = 0;  ///< the initiator's random number, repeated by every answer
};

/// Initiator: "let us begin". The longest of all, so that no answer is longer.
struct HelloMessage {
  HandshakeRoute route;
};

/// Responder: "show that you get what is sent to your address". It has kept nothing.
struct CookieMessage {
  HandshakeRoute route;
  CookieBytes cookie{};
};

/// Initiator: cookie as it came, and Noise message 1.
struct OpenMessage {
  HandshakeRoute route;
  std::uint16_t key_epoch = 0;
  CookieBytes cookie{};
  NoiseMessage noise{};
};

/// Responder: Noise message 2.
struct AcceptMessage {
  HandshakeRoute route;
  std::uint32_t session = 0;  ///< the initiator's, from the terms in OPEN
  std::uint16_t key_epoch = 0;
  NoiseMessage noise{};
};

/// Either: why not. Not authentic, so for the user's eyes only; never ends a live session.
struct RefuseMessage {
  HandshakeRoute route;
  RefuseCode code = RefuseCode::kVersion;
  std::uint8_t version = kWireVersion;  ///< that the sender speaks
};

/// Each writes one whole datagram and gives its size; 0, and nothing written, if there is no room
/// or the message is outside the standard.
[[nodiscard]] std::size_t encodeHello(const HelloMessage& message, ByteSpan out) noexcept;
[[nodiscard]] std::size_t encodeCookie(const CookieMessage& message, ByteSpan out) noexcept;
[[nodiscard]] std::size_t encodeOpen(const OpenMessage& message, ByteSpan out) noexcept;
[[nodiscard]] std::size_t encodeAccept(const AcceptMessage& message, ByteSpan out) noexcept;
[[nodiscard]] std::size_t encodeRefuse(const RefuseMessage& message, ByteSpan out) noexcept;

/// Each reads one whole datagram of its type.
[[nodiscard]] Decoded<HelloMessage> decodeHello(ByteView datagram) noexcept;
[[nodiscard]] Decoded<CookieMessage> decodeCookie(ByteView datagram) noexcept;
[[nodiscard]] Decoded<OpenMessage> decodeOpen(ByteView datagram) noexcept;
[[nodiscard]] Decoded<AcceptMessage> decodeAccept(ByteView datagram) noexcept;
[[nodiscard]] Decoded<RefuseMessage> decodeRefuse(ByteView datagram) noexcept;

/// Writes the REFUSE that answers a HELLO of another version, and gives its size; 0 if the datagram
/// is not one: HELLO and REFUSE are laid out alike in all versions.
[[nodiscard]] std::size_t encodeVersionRefusal(ByteView hello, ByteSpan out) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
