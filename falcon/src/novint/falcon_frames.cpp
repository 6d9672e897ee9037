#include "novint/falcon_frames.h"

#include <algorithm>

namespace tandem {
namespace {

constexpr std::uint8_t kStart = '<', kEnd = '>', kZero = 'A';
constexpr std::size_t kInfo = 13, kUnknown = 14, kLast = 15;
constexpr std::uint8_t kHoming = 0x01, kMostInfo = 0x7f, kCommandInfo = 0x0f;

void writeNumber(std::int16_t number, std::uint8_t* to) noexcept {
  const auto bits = static_cast<std::uint16_t>(number);
  for (int i = 0; i < 4; ++i) to[i] = static_cast<std::uint8_t>(kZero + ((bits >> (4 * i)) & 0xf));
}

std::int16_t readNumber(const std::uint8_t* from) noexcept {
  unsigned bits = 0;
  for (int i = 0; i < 4; ++i) bits |= static_cast<unsigned>(from[i] - kZero) << (4 * i);
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
}

FalconFrame makeFrame(const std::array<std::int16_t, 3>& numbers, std::uint8_t info) noexcept {
  FalconFrame frame;
  frame[0] = kStart;
  for (std::size_t i = 0; i < 3; ++i) writeNumber(numbers[i], &frame[1 + 4 * i]);
  frame[kInfo] = static_cast<std::uint8_t>(kZero + info);
  frame[kUnknown] = kZero;
  frame[kLast] = kEnd;
  return frame;
}

std::array<std::int16_t, 3> readNumbers(const FalconFrame& frame) noexcept {
  return {readNumber(&frame[1]), readNumber(&frame[5]), readNumber(&frame[9])};
}

std::uint8_t infoOf(const FalconFrame& frame) noexcept {
  return static_cast<std::uint8_t>(frame[kInfo] - kZero);
}

bool isNibble(std::uint8_t byte) noexcept { return byte >= kZero && byte < kZero + 16; }

}  // namespace

bool isFrame(const FalconFrame& frame) noexcept {
  // The meaning of byte 14 is unknown.
  return frame[0] == kStart && frame[kLast] == kEnd &&
         std::all_of(frame.begin() + 1, frame.begin() + kInfo, &isNibble) &&
         frame[kInfo] >= kZero && infoOf(frame) <= kMostInfo;
}

FalconFrame encodeCommand(const FalconCommand& command) noexcept {
  FalconMotors motors = command.motors;
  for (std::int16_t& motor : motors)
    motor = std::clamp<std::int16_t>(motor, -kMostMotor, kMostMotor);
  const auto lights = command.lights & (kGreenLight | kBlueLight | kRedLight);
  return makeFrame(motors, static_cast<std::uint8_t>(lights | (command.homes ? kHoming : 0)));
}

FalconFrame encodeReply(const FalconReply& reply) noexcept {
  return makeFrame(reply.counts,
                   static_cast<std::uint8_t>((reply.homed & 7) << 4 | (reply.buttons & 0xf)));
}

FalconCommand readCommand(const FalconFrame& frame) noexcept {
  const std::uint8_t info = infoOf(frame);
  return {readNumbers(frame), (info & kHoming) != 0,
          static_cast<std::uint8_t>(info & kCommandInfo & ~kHoming)};
}

std::optional<FalconCommand> decodeCommand(const FalconFrame& frame) noexcept {
  if (!isFrame(frame) || infoOf(frame) > kCommandInfo) return std::nullopt;
  const FalconCommand command = readCommand(frame);
  for (const std::int16_t motor : command.motors)
    if (motor < -kMostMotor || motor > kMostMotor) return std::nullopt;
  return command;
}

std::optional<FalconReply> decodeReply(const FalconFrame& frame) noexcept {
  if (!isFrame(frame)) return std::nullopt;
  FalconReply reply;
  reply.counts = readNumbers(frame);
  reply.homed = static_cast<std::uint8_t>(infoOf(frame) >> 4);
  reply.buttons = static_cast<std::uint8_t>(infoOf(frame) & 0xf);
  return reply;
}

std::optional<FalconFrame> FalconFrameReader::take(std::uint8_t byte) noexcept {
  if (size_ == 0 && byte != kStart) {
    ++dropped_;
    return std::nullopt;
  }
  bytes_[size_++] = byte;
  if (size_ < kFalconFrameSize) return std::nullopt;
  if (isFrame(bytes_)) {
    size_ = 0;
    ++frames_;
    return bytes_;
  }
  dropToNextStart();
  return std::nullopt;
}

/// Continues at the next start marker: a frame may have begun inside a false one.
void FalconFrameReader::dropToNextStart() noexcept {
  const auto next = std::find(bytes_.begin() + 1, bytes_.end(), kStart);
  dropped_ += static_cast<std::uint64_t>(next - bytes_.begin());
  size_ = static_cast<std::size_t>(bytes_.end() - next);
  std::copy(next, bytes_.end(), bytes_.begin());
}

}  // namespace tandem
