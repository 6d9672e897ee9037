#include "relay/relay_wire.h"

#include <algorithm>

#include "relay/wire_start.h"

namespace tandem::relay {
namespace {

using wire::ByteReader;

bool isNameCharacter(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '_' || c == '-';
}

}  // namespace

bool isRoomName(const RoomName& name) noexcept {
  const auto end = std::find(name.begin(), name.end(), '\0');
  return end != name.begin() && std::all_of(name.begin(), end, isNameCharacter) &&
         std::all_of(end, name.end(), [](char c) { return c == '\0'; });
}

std::optional<RoomName> makeRoomName(std::string_view text) noexcept {
  RoomName name{};
  if (text.size() > name.size()) return std::nullopt;
  std::copy(text.begin(), text.end(), name.begin());
  // A zero in the text would end the name early.
  const bool is_whole = std::find(text.begin(), text.end(), '\0') == text.end();
  return is_whole && isRoomName(name) ? std::optional(name) : std::nullopt;
}

std::string toString(const RoomName& name) {
  return {name.begin(), std::find(name.begin(), name.end(), '\0')};
}

std::optional<Type> readType(ByteView datagram) noexcept {
  ByteReader reader(datagram);
  if (!reader.has(kHeadSize) || reader.read<std::uint16_t>() != kMagic ||
      reader.read<std::uint8_t>() != kRelayVersion)
    return std::nullopt;
  return static_cast<Type>(reader.read<std::uint8_t>());
}

bool isHelloOfAnotherVersion(ByteView datagram) noexcept {
  ByteReader reader(datagram);
  return datagram.size == kHelloSize && reader.read<std::uint16_t>() == kMagic &&
         reader.read<std::uint8_t>() != kRelayVersion &&
         reader.read<std::uint8_t>() == static_cast<std::uint8_t>(Type::kHello);
}

}  // namespace tandem::relay
