#pragma once

#include <cstdint>
#include <optional>

#include "tandem/plugin/address.h"

#include "relay/relay_wire.h"

/// \file
/// Datagrams between a member of a room and the relay. Their last kShortTag bytes are a tag.
namespace tandem::relay {

/// First 16 bytes of the datagrams of a session.
struct SessionHead {
  std::uint32_t session = 0;
  std::uint64_t number = 0;  ///< sequence; of CHALLENGE the token
};
[[nodiscard]] SessionHead readHead(ByteView datagram) noexcept;

/// KEEP asks where another member is; `asked` 0 asks nothing.
std::size_t encodeKeep(const SessionHead& head, std::uint16_t asked, ByteSpan out) noexcept;
[[nodiscard]] std::optional<std::uint16_t> decodeKeep(ByteView datagram) noexcept;

/// Answer to KEEP.
struct Kept {
  std::uint16_t asked = 0;
  std::optional<Address> address;  ///< of that member as the relay sees it
  std::uint64_t members = 0;       ///< bit id - 1 for each member of the room
};
std::size_t encodeKept(const SessionHead& head, const Kept& kept, ByteSpan out) noexcept;
[[nodiscard]] std::optional<Kept> decodeKept(ByteView datagram) noexcept;

std::size_t encodeLeave(const SessionHead& head, ByteSpan out) noexcept;
std::size_t encodeChallenge(std::uint32_t session, std::uint64_t token, ByteSpan out) noexcept;
std::size_t encodeResponse(const SessionHead& head, std::uint64_t token, ByteSpan out) noexcept;
[[nodiscard]] bool isLeave(ByteView datagram) noexcept;
[[nodiscard]] bool isChallenge(ByteView datagram) noexcept;
[[nodiscard]] std::optional<std::uint64_t> decodeResponse(ByteView datagram) noexcept;

/// Writes the header of FORWARD before `inner_size` bytes that the caller puts behind it. Returns
/// the size with the tag.
std::size_t encodeForward(const SessionHead& head, std::uint16_t to, std::size_t inner_size,
                          ByteSpan out) noexcept;
/// The receiver of a FORWARD: a member, or kAllWatchers.
[[nodiscard]] std::optional<std::uint16_t> decodeForward(ByteView datagram) noexcept;
/// Turns a FORWARD into a FORWARDED in place. Returns its size.
std::size_t turnForward(std::uint16_t from, ByteSpan datagram) noexcept;
struct Forwarded {
  std::uint16_t from = 0;
  ByteSpan inner;
};
[[nodiscard]] std::optional<Forwarded> decodeForwarded(ByteSpan datagram) noexcept;

}  // namespace tandem::relay
