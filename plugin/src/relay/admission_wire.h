#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "relay/relay_wire.h"

/// \file
/// Datagrams by which a member comes into a room.
namespace tandem::relay {

/// Member and attempt of an admission; each answer repeats it.
struct Caller {
  std::uint16_t member = 0;
  std::uint64_t nonce = 0;  ///< rises with each attempt of a member
};

using CookieBytes = std::array<std::uint8_t, 16>;

/// HELLO and, with a cookie, JOIN.
struct Request {
  Caller caller;
  bool is_watcher = false;  ///< hears what is said to watchers, and says nothing
  RoomName room{};
  CookieBytes cookie{};  ///< zero in HELLO
};

/// Encoders leave the tag's bytes alone, and return the size. The room must suffice.
std::size_t encodeRequest(Type type, const Request& request, ByteSpan out) noexcept;
std::size_t encodeCookie(const Caller& caller, const CookieBytes& cookie, ByteSpan out) noexcept;
std::size_t encodeJoined(const Caller& caller, std::uint32_t session, ByteSpan out) noexcept;
std::size_t encodeRefuse(const Caller& caller, Code code, ByteSpan out) noexcept;

/// The caller in a HELLO of any version.
[[nodiscard]] Caller peekCaller(ByteView hello) noexcept;

/// Decoders read a whole datagram of their type, but not its tag.
[[nodiscard]] std::optional<Request> decodeRequest(ByteView datagram) noexcept;
struct CookieAnswer {
  Caller caller;
  CookieBytes cookie{};
};
[[nodiscard]] std::optional<CookieAnswer> decodeCookieAnswer(ByteView datagram) noexcept;
struct JoinedAnswer {
  Caller caller;
  std::uint32_t session = 0;
};
[[nodiscard]] std::optional<JoinedAnswer> decodeJoinedAnswer(ByteView datagram) noexcept;
struct RefuseAnswer {
  Caller caller;
  Code code = Code::kVersion;
  std::uint8_t version = kRelayVersion;  ///< of its sender
};
/// Reason and remedy: "another site has this id; give each its own". Allocates.
[[nodiscard]] std::string explain(const RefuseAnswer& answer);
[[nodiscard]] std::optional<RefuseAnswer> decodeRefuseAnswer(ByteView datagram) noexcept;

}  // namespace tandem::relay
