#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "tandem/falcon/falcon_status.h"

#include "novint/falcon_kinematics.h"

/// \file
/// What a Novint Falcon with its firmware running says and hears: frames of 16 bytes, each command
/// answered by one reply, at 1.5 MBd.
///
///     0     1 2 3 4    5 6 7 8    9 10 11 12    13      14    15
///    '<'    leg 1      leg 2      leg 3         info    'A'   '>'
///
/// A number is a signed 16-bit one in four bytes 'A' + nibble, the lowest first; info is
/// 'A' + 0 to 127. Bytes from a device are never trusted. Pure and real-time safe.
#pragma GCC visibility push(default)
namespace tandem {

inline constexpr std::size_t kFalconFrameSize = 16;
using FalconFrame = std::array<std::uint8_t, kFalconFrameSize>;

/// Lights of the device; several may be on.
enum FalconLight : std::uint8_t { kGreenLight = 0x02, kBlueLight = 0x04, kRedLight = 0x08 };

struct FalconCommand {
  FalconMotors motors{};    ///< clamped to what the motors take
  bool homes = false;       ///< homing mode: must be asked for in every frame
  std::uint8_t lights = 0;  ///< of FalconLight
};

struct FalconReply {
  std::array<std::int16_t, 3> counts{};  ///< of the legs' encoders
  std::uint8_t homed = 0;    ///< bit i: leg i + 1 has found its index; in homing mode only
  std::uint8_t buttons = 0;  ///< of FalconButton
  [[nodiscard]] bool isHomed() const noexcept { return homed == 7; }
};

[[nodiscard]] FalconFrame encodeCommand(const FalconCommand& command) noexcept;
[[nodiscard]] FalconFrame encodeReply(const FalconReply& reply) noexcept;
/// Nothing for 16 bytes that are no frame, or of the other kind as far as that can be told.
[[nodiscard]] std::optional<FalconCommand> decodeCommand(const FalconFrame& frame) noexcept;
[[nodiscard]] std::optional<FalconReply> decodeReply(const FalconFrame& frame) noexcept;

/// True if markers, nibbles and info are as in a frame.
[[nodiscard]] bool isFrame(const FalconFrame& frame) noexcept;

/// Finds frames in a stream of bytes that come in pieces, with some lost, doubled or wrong: after
/// any of that the next whole frame is found again.
class FalconFrameReader {
 public:
  /// The frame that ends with this byte, if one does.
  [[nodiscard]] std::optional<FalconFrame> take(std::uint8_t byte) noexcept;
  /// Forgets what has come of a frame.
  void clear() noexcept { size_ = 0; }

  [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
  /// Bytes that were part of no frame.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  void dropToNextStart() noexcept;

  FalconFrame bytes_{};
  std::size_t size_ = 0;
  std::uint64_t frames_ = 0, dropped_ = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
