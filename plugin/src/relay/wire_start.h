#pragma once

#include "coordination/src/wire/byte_reader.h"
#include "coordination/src/wire/byte_writer.h"
#include "relay/relay_wire.h"

/// \file
/// The bytes that all datagrams of a relay begin with, for their encoders and decoders.
namespace tandem::relay {

inline constexpr std::uint16_t kMagic = 0x7254;  ///< "Tr"
inline constexpr std::size_t kTypeOffset = 3;
inline constexpr std::size_t kHeadSize = 16;  ///< up to nonce or sequence

inline void writeStart(wire::ByteWriter& writer, Type type) noexcept {
  writer.write(kMagic);
  writer.write(kRelayVersion);
  writer.write(static_cast<std::uint8_t>(type));
}

[[nodiscard]] inline bool isMember(std::uint16_t id) noexcept {
  return id >= 1 && id <= kMostMembers;
}

/// A reader of what is between the first `skipped` bytes and the last `tag` bytes, if the datagram
/// has this type and size.
[[nodiscard]] inline std::optional<wire::ByteReader> open(ByteView datagram, Type type,
                                                          std::size_t size, std::size_t skipped,
                                                          std::size_t tag) noexcept {
  if (datagram.size != size || readType(datagram) != type) return std::nullopt;
  return wire::ByteReader({datagram.data + skipped, size - skipped - tag});
}

}  // namespace tandem::relay
