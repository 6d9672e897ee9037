#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "wire/wire.h"

/// \file
/// The unencrypted datagrams of the handshake (section 4), with their headers. The caller makes the
/// contents of the Noise messages, the cookie and the tags.
#pragma GCC visibility push(default)
namespace tandem {

inline constexpr std::size_t kHelloSize = 256;  ///< [bytes]; these sizes include the header
inline constexpr std::size_t kCookieSize = 64;
inline constexpr std::size_t kOpenSize = 120;
inline constexpr std::size_t kAcceptSize = 88;
inline constexpr std::size_t kRefuseSize = 32;

using CookieBytes = std::array<std::uint8_t, 16>;
using HandshakeTag = std::array<std::uint8_t, 16>;
using NoiseMessage = std::array<std::uint8_t, 56>;  ///< key 32, sealed terms 8, tag 16

/// Sender, receiver and attempt of a handshake.
struct HandshakeRoute {
  PeerId sender{};
  PeerId receiver{};
  std::uint64_t nonce = 0;  ///< of HELLO: rises with each handshake; every answer repeats it
};

/// Initiator: asks to begin. Responder: asks for such a call, at the address it comes from. The
/// longest of all, so that no answer amplifies it.
struct HelloMessage {
  HandshakeRoute route;
  HandshakeTag tag{};  ///< over all bytes before it, under the pair's key
};

/// Responder: asks for proof that the initiator acts now, and not a recording of it. It has stored
/// nothing.
struct CookieMessage {
  HandshakeRoute route;
  CookieBytes cookie{};
  HandshakeTag tag{};  ///< as in HELLO
};

/// Initiator: returns the cookie, with Noise message 1.
struct OpenMessage {
  HandshakeRoute route;
  std::uint16_t key_epoch = 0;
  CookieBytes cookie{};
  NoiseMessage noise{};
  HandshakeTag tag{};  ///< as in HELLO
};

/// Responder: Noise message 2.
struct AcceptMessage {
  HandshakeRoute route;
  std::uint32_t session = 0;  ///< the initiator's, from the terms in OPEN
  std::uint16_t key_epoch = 0;
  NoiseMessage noise{};
};

/// Either side: the reason of a refusal. It is not authentic: show it to the user only; it never
/// ends a live session.
struct RefuseMessage {
  HandshakeRoute route;
  RefuseCode code = RefuseCode::kVersion;
  std::uint8_t version = kWireVersion;  ///< version that the sender speaks
};

/// HELLO, COOKIE and OPEN carry their tags behind these many bytes.
inline constexpr std::size_t kHelloTagOffset = 32;
inline constexpr std::size_t kCookieTagOffset = 48;
inline constexpr std::size_t kOpenTagOffset = 104;

/// Each encoder writes one whole datagram and returns its size. It returns 0, with nothing written,
/// if there is no room or the message is outside the standard.
[[nodiscard]] std::size_t encodeHello(const HelloMessage& message, ByteSpan out) noexcept;
[[nodiscard]] std::size_t encodeCookie(const CookieMessage& message, ByteSpan out) noexcept;
[[nodiscard]] std::size_t encodeOpen(const OpenMessage& message, ByteSpan out) noexcept;
[[nodiscard]] std::size_t encodeAccept(const AcceptMessage& message, ByteSpan out) noexcept;
[[nodiscard]] std::size_t encodeRefuse(const RefuseMessage& message, ByteSpan out) noexcept;

/// Each decoder reads one whole datagram of its type.
[[nodiscard]] Decoded<HelloMessage> decodeHello(ByteView datagram) noexcept;
[[nodiscard]] Decoded<CookieMessage> decodeCookie(ByteView datagram) noexcept;
[[nodiscard]] Decoded<OpenMessage> decodeOpen(ByteView datagram) noexcept;
[[nodiscard]] Decoded<AcceptMessage> decodeAccept(ByteView datagram) noexcept;
[[nodiscard]] Decoded<RefuseMessage> decodeRefuse(ByteView datagram) noexcept;

/// Writes the REFUSE that answers a HELLO of another version, and returns its size. 0 if the
/// datagram is not such a HELLO. HELLO and REFUSE have the same layout in all versions.
[[nodiscard]] std::size_t encodeVersionRefusal(ByteView hello, ByteSpan out) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
