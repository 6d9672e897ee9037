#include "wire/wire.h"

#include <array>

#include "wire/byte_reader.h"
#include "wire/byte_writer.h"

namespace tandem {
namespace {

constexpr std::uint16_t kMagic = 0x6454;  // "Td"

constexpr std::array<const char*, kWireRefusals> kNames = {
    "none",        "too_short",    "too_long",     "wrong_size",
    "magic",       "version",      "type",         "session",
    "sender",      "key_epoch",    "sequence",     "receiver",
    "role",        "zero",         "code",         "terms",
    "profile",     "object_count", "flags",        "time",
    "energy",      "object_id",    "object_twice", "object_epoch",
    "not_finite",  "position",     "velocity",     "angular_velocity",
    "orientation", "part",         "parts",        "key",
    "value",       "order",        "verdict",      "reason"};

bool isType(std::uint8_t type) noexcept {
  const auto within = [type](MessageType first, MessageType last) {
    return type >= static_cast<std::uint8_t>(first) && type <= static_cast<std::uint8_t>(last);
  };
  return within(MessageType::kHello, MessageType::kRefuse) ||
         within(MessageType::kState, MessageType::kPathResponse);
}

/// Checks the fields behind the type (section 3).
WireRefusal findFault(const ClearHeader& header) noexcept {
  const bool sealed = isSealed(header.type);
  const bool addressed = sealed || header.type == MessageType::kAccept;
  const bool keyed = addressed || header.type == MessageType::kOpen;
  const auto sender = static_cast<std::uint32_t>(header.sender);
  if ((header.session != 0) != addressed) return WireRefusal::kSession;
  if (sender < 1 || sender > kMaxPeerId) return WireRefusal::kSender;
  if ((header.key_epoch != 0) != keyed) return WireRefusal::kKeyEpoch;
  if (!sealed && header.sequence != 0) return WireRefusal::kSequence;
  return WireRefusal::kNone;
}

bool speaksOurVersion(std::uint8_t version, std::uint8_t type) noexcept {
  return version == kWireVersion || type == static_cast<std::uint8_t>(MessageType::kRefuse);
}

}  // namespace

const char* name(WireRefusal refusal) noexcept {
  const auto index = static_cast<std::size_t>(refusal);
  return index < kNames.size() ? kNames[index] : "unknown";
}

std::size_t encodeHeader(const ClearHeader& header, ByteSpan out) noexcept {
  const auto type = static_cast<std::uint8_t>(header.type);
  if (out.size < kHeaderSize || !isType(type) || !speaksOurVersion(header.version, type)) return 0;
  if (findFault(header) != WireRefusal::kNone) return 0;
  wire::ByteWriter writer(out);
  writer.write(kMagic);
  writer.write(header.version);
  writer.write(type);
  writer.write(header.session);
  writer.write(static_cast<std::uint16_t>(header.sender));
  writer.write(header.key_epoch);
  writer.write(header.sequence);
  return writer.size();
}

Decoded<ClearHeader> decodeHeader(ByteView datagram) noexcept {
  if (datagram.size < kHeaderSize) return WireRefusal::kTooShort;
  if (datagram.size > kMaxDatagramSize) return WireRefusal::kTooLong;
  wire::ByteReader reader(datagram);
  if (reader.read<std::uint16_t>() != kMagic) return WireRefusal::kMagic;
  const auto version = reader.read<std::uint8_t>();
  const auto type = reader.read<std::uint8_t>();
  if (!speaksOurVersion(version, type)) return WireRefusal::kVersion;
  if (!isType(type)) return WireRefusal::kType;

  Decoded<ClearHeader> header(WireRefusal::kNone);
  header->type = static_cast<MessageType>(type);
  header->version = version;
  header->session = reader.read<std::uint32_t>();
  header->sender = PeerId{reader.read<std::uint16_t>()};
  header->key_epoch = reader.read<std::uint16_t>();
  header->sequence = reader.read<std::uint64_t>();
  const WireRefusal fault = findFault(*header);
  return fault == WireRefusal::kNone ? header : fault;
}

std::size_t encodeBye(ByeReason reason, ByteSpan out) noexcept {
  if (out.size < kByeSize || reason > ByeReason::kConfigurationsDiffer) return 0;
  out.data[0] = static_cast<std::uint8_t>(reason);
  return kByeSize;
}

Decoded<ByeReason> decodeBye(ByteView payload) noexcept {
  if (payload.size != kByeSize) return WireRefusal::kWrongSize;
  if (payload.data[0] > static_cast<std::uint8_t>(ByeReason::kConfigurationsDiffer))
    return WireRefusal::kReason;
  Decoded<ByeReason> reason(WireRefusal::kNone);
  *reason = static_cast<ByeReason>(payload.data[0]);
  return reason;
}

std::size_t encodePath(PathToken token, ByteSpan out) noexcept {
  if (out.size < kPathSize) return 0;
  wire::ByteWriter writer(out);
  writer.write(token);
  return kPathSize;
}

Decoded<PathToken> decodePath(ByteView payload) noexcept {
  if (payload.size != kPathSize) return WireRefusal::kWrongSize;
  wire::ByteReader reader(payload);
  Decoded<PathToken> token(WireRefusal::kNone);
  *token = reader.read<PathToken>();
  return token;
}

}  // namespace tandem
