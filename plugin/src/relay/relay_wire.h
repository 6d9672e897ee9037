#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "tandem/coordination/datagram.h"
#include "tandem/coordination/types.h"

/// \file
/// Datagrams between a relay and the members of its rooms. docs/relay.md defines the format. All
/// functions are pure, check every byte, and neither throw nor allocate unless they say so.
namespace tandem::relay {

inline constexpr std::uint8_t kRelayVersion = 1;
inline constexpr std::uint16_t kMostMembers = kMaxPeerId;  ///< of a room, whose ids are peers'
inline constexpr std::uint16_t kAllWatchers = 0xffff;  ///< as receiver: each watcher of the room

/// First byte after the version.
enum class Type : std::uint8_t {
  kHello = 1,
  kCookie = 2,
  kJoin = 3,
  kJoined = 4,
  kRefuse = 5,
  kKeep = 16,
  kKept = 17,
  kLeave = 18,
  kChallenge = 19,
  kResponse = 20,
  kForward = 32,
  kForwarded = 33,
};

/// Reason of a REFUSE.
enum class Code : std::uint8_t {
  kVersion = 1,  ///< the relay speaks another version
  kKey = 2,      ///< HELLO or JOIN is not tagged under the relay's key
  kRooms = 3,    ///< all rooms are in use
  kMembers = 4,  ///< the room is full
  kTaken = 5,    ///< a live member has this id
  kSession = 6,  ///< the relay does not know the session; join again
};

// Sizes of whole datagrams [bytes].
inline constexpr std::size_t kHelloSize = 128;
inline constexpr std::size_t kCookieSize = 48;
inline constexpr std::size_t kJoinSize = 128;
inline constexpr std::size_t kJoinedSize = 40;
inline constexpr std::size_t kRefuseSize = 16;
inline constexpr std::size_t kKeepSize = 64;
inline constexpr std::size_t kKeptSize = 64;
inline constexpr std::size_t kLeaveSize = 24;
inline constexpr std::size_t kChallengeSize = 24;
inline constexpr std::size_t kResponseSize = 32;
inline constexpr std::size_t kForwardHeader = 20;
inline constexpr std::size_t kShortTag = 8;  ///< last bytes of a datagram of a session
inline constexpr std::size_t kLongTag = 16;  ///< last bytes of a datagram of the admission
inline constexpr std::size_t kMaxForward = kForwardHeader + kMaxDatagramSize + kShortTag;

/// Name of a room, padded with zeros: 1 to 32 letters, digits, '.', '_' or '-'.
using RoomName = std::array<char, 32>;

[[nodiscard]] bool isRoomName(const RoomName& name) noexcept;
/// Empty if the text cannot name a room.
[[nodiscard]] std::optional<RoomName> makeRoomName(std::string_view text) noexcept;
/// Allocates.
[[nodiscard]] std::string toString(const RoomName& name);

/// The type of a datagram of this version; empty if it is none of a relay.
[[nodiscard]] std::optional<Type> readType(ByteView datagram) noexcept;
/// True for a HELLO of another version, whose sender is told so.
[[nodiscard]] bool isHelloOfAnotherVersion(ByteView datagram) noexcept;

}  // namespace tandem::relay
