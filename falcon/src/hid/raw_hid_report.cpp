#include "hid/raw_hid_report.h"

#include <algorithm>
#include <cmath>

namespace tandem {
namespace {

constexpr std::uint8_t kVersion = 1, kStateKind = 'S', kCommandKind = 'C';
constexpr std::uint8_t kAllLegs = 7, kAllFlags = kRawHidDrive | kRawHidHome;
constexpr std::size_t kNumber = 2, kLegs = 4, kBits = 10, kButtons = 11, kTime = 12, kCrc = 62;
constexpr std::size_t kStateEnd = 16, kCommandEnd = 11;

void writeBytes(std::uint32_t value, std::size_t count, std::uint8_t* to) noexcept {
  for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::uint32_t readBytes(const std::uint8_t* from, std::size_t count) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= static_cast<std::uint32_t>(from[i]) << (8 * i);
  return value;
}

std::uint16_t readShort(const std::uint8_t* from) noexcept {
  return static_cast<std::uint16_t>(readBytes(from, 2));
}

RawHidBytes begin(std::uint8_t kind, std::uint16_t number,
                  const std::array<std::int16_t, 3>& legs) noexcept {
  RawHidBytes bytes{kVersion, kind};
  writeBytes(number, 2, &bytes[kNumber]);
  for (std::size_t i = 0; i < 3; ++i)
    writeBytes(static_cast<std::uint16_t>(legs[i]), 2, &bytes[kLegs + 2 * i]);
  return bytes;
}

void seal(RawHidBytes& bytes) noexcept {
  writeBytes(computeCrc16(bytes.data(), kCrc), 2, &bytes[kCrc]);
}

/// Checks common to both kinds. Bytes from `end` to the CRC must be 0.
bool isSound(const std::uint8_t* bytes, std::size_t size, std::uint8_t kind,
             std::size_t end) noexcept {
  return size == kRawHidSize && bytes[0] == kVersion && bytes[1] == kind &&
         std::all_of(bytes + end, bytes + kCrc, [](std::uint8_t byte) { return byte == 0; }) &&
         readShort(bytes + kCrc) == computeCrc16(bytes, kCrc);
}

std::array<std::int16_t, 3> readLegs(const std::uint8_t* bytes) noexcept {
  std::array<std::int16_t, 3> legs{};
  for (std::size_t i = 0; i < 3; ++i)
    legs[i] = static_cast<std::int16_t>(readShort(bytes + kLegs + 2 * i));
  return legs;
}

}  // namespace

RawHidBytes encodeRawState(const RawHidState& state) noexcept {
  RawHidBytes bytes = begin(kStateKind, state.number, state.counts);
  bytes[kBits] = state.homed & kAllLegs;
  bytes[kButtons] = state.buttons;
  writeBytes(state.time_us, 4, &bytes[kTime]);
  seal(bytes);
  return bytes;
}

RawHidBytes encodeRawCommand(const RawHidCommand& command) noexcept {
  const bool drives = (command.flags & kRawHidDrive) != 0;
  RawHidBytes bytes =
      begin(kCommandKind, command.number, drives ? command.torques : std::array<std::int16_t, 3>{});
  bytes[kBits] = command.flags & kAllFlags;
  seal(bytes);
  return bytes;
}

std::optional<RawHidState> decodeRawState(const std::uint8_t* bytes, std::size_t size) noexcept {
  if (!isSound(bytes, size, kStateKind, kStateEnd) || bytes[kBits] > kAllLegs) return std::nullopt;
  RawHidState state;
  state.number = readShort(bytes + kNumber);
  state.counts = readLegs(bytes);
  state.homed = bytes[kBits];
  state.buttons = bytes[kButtons];
  state.time_us = readBytes(bytes + kTime, 4);
  return state;
}

std::optional<RawHidCommand> decodeRawCommand(const std::uint8_t* bytes,
                                              std::size_t size) noexcept {
  if (!isSound(bytes, size, kCommandKind, kCommandEnd) || bytes[kBits] > kAllFlags)
    return std::nullopt;
  RawHidCommand command;
  command.number = readShort(bytes + kNumber);
  command.torques = readLegs(bytes);
  command.flags = bytes[kBits];
  const bool drives = (command.flags & kRawHidDrive) != 0;
  if (!drives && command.torques != std::array<std::int16_t, 3>{}) return std::nullopt;
  return command;
}

HidReport toReport(const RawHidBytes& bytes) noexcept {
  HidReport report;
  std::copy(bytes.begin(), bytes.end(), report.bytes.begin() + 1);
  report.size = 1 + bytes.size();
  return report;
}

std::array<std::int16_t, 3> makeRawTorques(const Vec3& torques) noexcept {
  constexpr double kMost = 32767.0;
  std::array<std::int16_t, 3> units{};
  if (!torques.allFinite()) return units;
  const double largest = torques.cwiseAbs().maxCoeff() / kRawHidTorque;
  const double scale = (largest > kMost ? kMost / largest : 1.0) / kRawHidTorque;
  for (std::size_t i = 0; i < 3; ++i) {
    const double unit = std::round(torques[static_cast<Eigen::Index>(i)] * scale);
    units[i] = static_cast<std::int16_t>(std::clamp(unit, -kMost, kMost));
  }
  return units;
}

std::uint16_t computeCrc16(const std::uint8_t* bytes, std::size_t size) noexcept {
  constexpr unsigned kPolynomial = 0x1021, kTop = 0x8000;
  unsigned crc = 0xFFFF;
  for (std::size_t i = 0; i < size; ++i) {
    crc ^= static_cast<unsigned>(bytes[i]) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc & kTop) != 0 ? kPolynomial : 0);
    crc &= 0xFFFF;
  }
  return static_cast<std::uint16_t>(crc);
}

std::vector<std::uint8_t> makeRawHidDescriptor() {
  return {0x06, 0xAB, 0xFF, 0x0A, 0x00, 0x02, 0xA1, 0x01,  // usage page FFAB, usage 0200
          0x75, 0x08, 0x15, 0x00, 0x26, 0xFF, 0x00,        // bytes
          0x95, 0x40, 0x09, 0x01, 0x81, 0x02,              // 64 of them in
          0x95, 0x40, 0x09, 0x02, 0x91, 0x02, 0xC0};       // 64 of them out
}

}  // namespace tandem
