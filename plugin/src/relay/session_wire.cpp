#include "relay/session_wire.h"

#include "relay/wire_start.h"

namespace tandem::relay {
namespace {

using wire::ByteReader;
using wire::ByteWriter;

constexpr std::size_t kReceiverOffset = kHeadSize;
constexpr std::size_t kInnerLeast = 20;  ///< the clear header of a site's datagram

void writeHead(ByteWriter& writer, Type type, const SessionHead& head) noexcept {
  writeStart(writer, type);
  writer.write(head.session);
  writer.write(head.number);
}

}  // namespace

SessionHead readHead(ByteView datagram) noexcept {
  ByteReader reader({datagram.data + kTypeOffset + 1, datagram.size - kTypeOffset - 1});
  SessionHead head;
  head.session = reader.read<std::uint32_t>();
  head.number = reader.read<std::uint64_t>();
  return head;
}

std::size_t encodeKeep(const SessionHead& head, std::uint16_t asked, ByteSpan out) noexcept {
  ByteWriter writer(out);
  writeHead(writer, Type::kKeep, head);
  writer.write(asked);
  writer.writeZeros(kKeepSize - kShortTag - writer.size());
  return kKeepSize;
}

std::optional<std::uint16_t> decodeKeep(ByteView datagram) noexcept {
  auto reader = open(datagram, Type::kKeep, kKeepSize, kHeadSize, kShortTag);
  if (!reader) return std::nullopt;
  const auto asked = reader->read<std::uint16_t>();
  if (asked > kMostMembers || !reader->hasOnlyZeros()) return std::nullopt;
  return asked;
}

std::size_t encodeKept(const SessionHead& head, const Kept& kept, ByteSpan out) noexcept {
  ByteWriter writer(out);
  writeHead(writer, Type::kKept, head);
  writer.write(kept.asked);
  const Address address = kept.address.value_or(Address{});
  writer.write(address.port);
  writer.writeBytes(address.ip);
  writer.write(kept.members);
  writer.writeZeros(kKeptSize - kShortTag - writer.size());
  return kKeptSize;
}

std::optional<Kept> decodeKept(ByteView datagram) noexcept {
  auto reader = open(datagram, Type::kKept, kKeptSize, kHeadSize, kShortTag);
  if (!reader) return std::nullopt;
  Kept kept;
  kept.asked = reader->read<std::uint16_t>();
  Address address;
  address.port = reader->read<std::uint16_t>();
  reader->readInto(address.ip);
  kept.members = reader->read<std::uint64_t>();
  if (address.port != 0) kept.address = address;
  if (kept.asked > kMostMembers || !reader->hasOnlyZeros()) return std::nullopt;
  return kept;
}

std::size_t encodeLeave(const SessionHead& head, ByteSpan out) noexcept {
  ByteWriter writer(out);
  writeHead(writer, Type::kLeave, head);
  return kLeaveSize;
}

std::size_t encodeChallenge(std::uint32_t session, std::uint64_t token, ByteSpan out) noexcept {
  ByteWriter writer(out);
  writeHead(writer, Type::kChallenge, {session, token});
  return kChallengeSize;
}

std::size_t encodeResponse(const SessionHead& head, std::uint64_t token, ByteSpan out) noexcept {
  ByteWriter writer(out);
  writeHead(writer, Type::kResponse, head);
  writer.write(token);
  return kResponseSize;
}

bool isLeave(ByteView datagram) noexcept {
  return datagram.size == kLeaveSize && readType(datagram) == Type::kLeave;
}

bool isChallenge(ByteView datagram) noexcept {
  return datagram.size == kChallengeSize && readType(datagram) == Type::kChallenge;
}

std::optional<std::uint64_t> decodeResponse(ByteView datagram) noexcept {
  auto reader = open(datagram, Type::kResponse, kResponseSize, kHeadSize, kShortTag);
  if (!reader) return std::nullopt;
  return reader->read<std::uint64_t>();
}

std::size_t encodeForward(const SessionHead& head, std::uint16_t to, std::size_t inner_size,
                          ByteSpan out) noexcept {
  ByteWriter writer(out);
  writeHead(writer, Type::kForward, head);
  writer.write(to);
  writer.write(std::uint16_t{0});
  return kForwardHeader + inner_size + kShortTag;
}

std::optional<std::uint16_t> decodeForward(ByteView datagram) noexcept {
  const bool fits =
      datagram.size >= kForwardHeader + kInnerLeast + kShortTag && datagram.size <= kMaxForward;
  if (!fits) return std::nullopt;
  auto reader = open(datagram, Type::kForward, datagram.size, kHeadSize, kShortTag);
  if (!reader) return std::nullopt;
  const auto to = reader->read<std::uint16_t>();
  const bool is_receiver = isMember(to) || to == kAllWatchers;
  if (!is_receiver || reader->read<std::uint16_t>() != 0) return std::nullopt;
  return to;
}

std::size_t turnForward(std::uint16_t from, ByteSpan datagram) noexcept {
  datagram.data[kTypeOffset] = static_cast<std::uint8_t>(Type::kForwarded);
  // The session number is the sender's business.
  wire::storeLittleEndian(std::uint32_t{0}, datagram.data + kTypeOffset + 1);
  wire::storeLittleEndian(from, datagram.data + kReceiverOffset);
  return datagram.size - kShortTag;
}

std::optional<Forwarded> decodeForwarded(ByteSpan datagram) noexcept {
  const ByteView bytes{datagram.data, datagram.size};
  if (datagram.size < kForwardHeader + kInnerLeast ||
      datagram.size > kForwardHeader + kMaxDatagramSize)
    return std::nullopt;
  auto reader = open(bytes, Type::kForwarded, datagram.size, kHeadSize, 0);
  if (!reader || readHead(bytes).session != 0) return std::nullopt;
  const auto from = reader->read<std::uint16_t>();
  if (!isMember(from) || reader->read<std::uint16_t>() != 0) return std::nullopt;
  return Forwarded{from, {datagram.data + kForwardHeader, datagram.size - kForwardHeader}};
}

}  // namespace tandem::relay
