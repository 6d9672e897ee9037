#pragma once

#include <array>

#include "coordination/src/wire/wire_handshake.h"
#include "secure/handshake_tag.h"

namespace tandem::net {

/// Writes HELLO with its tag. Returns its size, 0 if there is no room.
[[nodiscard]] inline std::size_t writeHello(const HandshakeRoute& route, const SecretKey& key,
                                            ByteSpan out) noexcept {
  HelloMessage hello{route, {}};
  if (encodeHello(hello, out) == 0) return 0;
  hello.tag = secure::computeTag(key, {out.data, kHelloTagOffset});
  return encodeHello(hello, out);
}

/// The same for COOKIE.
[[nodiscard]] inline std::size_t writeCookie(const HandshakeRoute& route, const CookieBytes& cookie,
                                             const SecretKey& key, ByteSpan out) noexcept {
  CookieMessage message{route, cookie, {}};
  if (encodeCookie(message, out) == 0) return 0;
  message.tag = secure::computeTag(key, {out.data, kCookieTagOffset});
  return encodeCookie(message, out);
}

/// Sets the tag of OPEN.
inline void tagOpen(OpenMessage& open, const SecretKey& key) noexcept {
  std::array<std::uint8_t, kOpenSize> datagram;
  if (encodeOpen(open, {datagram.data(), datagram.size()}) != 0)
    open.tag = secure::computeTag(key, {datagram.data(), kOpenTagOffset});
}

/// True if the datagram that a decoder accepted was tagged under this key.
[[nodiscard]] inline bool isAuthentic(const HelloMessage& message, ByteView datagram,
                                      const SecretKey& key) noexcept {
  return secure::isTagged(key, {datagram.data, kHelloTagOffset}, message.tag);
}
[[nodiscard]] inline bool isAuthentic(const CookieMessage& message, ByteView datagram,
                                      const SecretKey& key) noexcept {
  return secure::isTagged(key, {datagram.data, kCookieTagOffset}, message.tag);
}
[[nodiscard]] inline bool isAuthentic(const OpenMessage& message, ByteView datagram,
                                      const SecretKey& key) noexcept {
  return secure::isTagged(key, {datagram.data, kOpenTagOffset}, message.tag);
}

}  // namespace tandem::net
