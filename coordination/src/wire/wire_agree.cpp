#include "wire/wire_agree.h"

#include "wire/byte_reader.h"
#include "wire/byte_writer.h"

namespace tandem {
namespace {

constexpr std::size_t kAgreeHead = 7;
constexpr std::size_t kAckHead = 9;
constexpr std::size_t kMinAckSize = kAckHead + 2;  // plus the lengths of key and value

constexpr std::size_t sizeOf(const ConfigurationItem& item) noexcept {
  return 2 + item.key.size() + item.value.size();
}

std::size_t sizeOf(const Configuration& items) noexcept {
  std::size_t size = kAgreeHead;
  for (const ConfigurationItem& item : items) size += sizeOf(item);
  return size;
}

/// Reads a length and a text; kWrongSize if the bytes end too early.
Decoded<std::string_view> readText(wire::ByteReader& reader) noexcept {
  if (!reader.has(1)) return WireRefusal::kWrongSize;
  const std::size_t length = reader.read<std::uint8_t>();
  if (!reader.has(length)) return WireRefusal::kWrongSize;
  Decoded<std::string_view> text(WireRefusal::kNone);
  *text = reader.readText(length);
  return text;
}

WireRefusal findFault(const ConfigurationItem& item) noexcept {
  if (!isConfigurationKey(item.key)) return WireRefusal::kKey;
  if (!isConfigurationValue(item.value)) return WireRefusal::kValue;
  return WireRefusal::kNone;
}

/// Reads the next item and appends it.
WireRefusal readItem(wire::ByteReader& reader, Configuration& items) {
  const auto key = readText(reader);
  if (!key) return key.refusal();
  if (!isConfigurationKey(*key)) return WireRefusal::kKey;
  const auto value = readText(reader);
  if (!value) return value.refusal();
  if (!isConfigurationValue(*value)) return WireRefusal::kValue;
  if (!items.empty() && *key <= items.back().key) return WireRefusal::kOrder;
  items.push_back({std::string(*key), std::string(*value)});
  return WireRefusal::kNone;
}

bool isAllowed(const AgreePart& part) noexcept {
  if (part.parts < 1 || part.parts > kMaxAgreeParts || part.part >= part.parts) return false;
  if (part.items.size() > 255 || sizeOf(part.items) > kMaxPayloadSize) return false;
  for (std::size_t i = 0; i < part.items.size(); ++i) {
    if (findFault(part.items[i]) != WireRefusal::kNone) return false;
    if (i > 0 && part.items[i].key <= part.items[i - 1].key) return false;
  }
  return true;
}

/// Only the verdict kDifferent names a key.
bool mayBeKey(std::string_view key, AgreeVerdict verdict) noexcept {
  return verdict == AgreeVerdict::kDifferent ? isConfigurationKey(key) : key.empty();
}

bool mayBeValue(std::string_view value, AgreeVerdict verdict) noexcept {
  return value.empty() || (verdict == AgreeVerdict::kDifferent && isConfigurationValue(value));
}

}  // namespace

std::size_t encodeAgree(const AgreePart& part, ByteSpan out) {
  if (!isAllowed(part) || out.size < sizeOf(part.items)) return 0;
  wire::ByteWriter writer(out);
  writer.write(part.config_hash);
  writer.write(part.part);
  writer.write(part.parts);
  writer.write(static_cast<std::uint8_t>(part.items.size()));
  for (const ConfigurationItem& item : part.items) {
    writer.writeText(item.key);
    writer.writeText(item.value);
  }
  return writer.size();
}

Decoded<AgreePart> decodeAgree(ByteView payload) {
  if (payload.size < kAgreeHead) return WireRefusal::kTooShort;
  if (payload.size > kMaxPayloadSize) return WireRefusal::kTooLong;
  wire::ByteReader reader(payload);
  Decoded<AgreePart> part(WireRefusal::kNone);
  part->config_hash = reader.read<std::uint32_t>();
  part->part = reader.read<std::uint8_t>();
  part->parts = reader.read<std::uint8_t>();
  const std::size_t item_count = reader.read<std::uint8_t>();
  if (part->parts < 1 || part->parts > kMaxAgreeParts) return WireRefusal::kParts;
  if (part->part >= part->parts) return WireRefusal::kPart;
  for (std::size_t i = 0; i < item_count; ++i)
    if (const auto fault = readItem(reader, part->items); fault != WireRefusal::kNone) return fault;
  if (reader.left() > 0) return WireRefusal::kWrongSize;
  return part;
}

std::size_t encodeAgreeAck(const AgreeAnswer& answer, ByteSpan out) {
  if (answer.verdict > AgreeVerdict::kDifferent || !mayBeKey(answer.key, answer.verdict) ||
      !mayBeValue(answer.value, answer.verdict) ||
      out.size < kMinAckSize + answer.key.size() + answer.value.size())
    return 0;
  wire::ByteWriter writer(out);
  writer.write(answer.config_hash);
  writer.write(answer.parts_received);
  writer.write(static_cast<std::uint8_t>(answer.verdict));
  writer.writeText(answer.key);
  writer.writeText(answer.value);
  return writer.size();
}

Decoded<AgreeAnswer> decodeAgreeAck(ByteView payload) {
  if (payload.size < kMinAckSize) return WireRefusal::kTooShort;
  wire::ByteReader reader(payload);
  Decoded<AgreeAnswer> answer(WireRefusal::kNone);
  answer->config_hash = reader.read<std::uint32_t>();
  answer->parts_received = reader.read<std::uint32_t>();
  const auto verdict = reader.read<std::uint8_t>();
  if (verdict > static_cast<std::uint8_t>(AgreeVerdict::kDifferent)) return WireRefusal::kVerdict;
  answer->verdict = static_cast<AgreeVerdict>(verdict);
  const auto key = readText(reader);
  if (!key) return key.refusal();
  if (!mayBeKey(*key, answer->verdict)) return WireRefusal::kKey;
  const auto value = readText(reader);
  if (!value) return value.refusal();
  if (!mayBeValue(*value, answer->verdict)) return WireRefusal::kValue;
  if (reader.left() > 0) return WireRefusal::kWrongSize;
  answer->key = *key;
  answer->value = *value;
  return answer;
}

}  // namespace tandem
