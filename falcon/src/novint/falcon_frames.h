#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "tandem/falcon/falcon_status.h"

#include "novint/falcon_kinematics.h"

/// \file
/// Messages of a Novint Falcon with running firmware: frames of 16 bytes at 1.5 MBd. The device
/// answers each command with one reply.
///
///     0     1 2 3 4    5 6 7 8    9 10 11 12    13      14    15
///    '<'    leg 1      leg 2      leg 3         info    'A'   '>'
///
/// A number is signed 16-bit in four bytes 'A' + nibble, the lowest nibble first. The info byte is
/// 'A' + 0 to 127. Every byte from a device is checked. Pure and real-time safe.
namespace tandem {

inline constexpr std::size_t kFalconFrameSize = 16;
using FalconFrame = std::array<std::uint8_t, kFalconFrameSize>;

/// Lights of the device; several may be on.
enum FalconLight : std::uint8_t { kGreenLight = 0x02, kBlueLight = 0x04, kRedLight = 0x08 };

struct FalconCommand {
  FalconMotors motors{};    ///< encodeCommand clamps them to their range
  bool homes = false;       ///< homing mode; must be set in every frame
  std::uint8_t lights = 0;  ///< bits of FalconLight
};

struct FalconReply {
  std::array<std::int16_t, 3> counts{};  ///< encoder counts of the legs
  std::uint8_t homed = 0;    ///< bit i: leg i + 1 has found its index; in homing mode only
  std::uint8_t buttons = 0;  ///< bits of FalconButton
  [[nodiscard]] bool isHomed() const noexcept { return homed == 7; }
};

[[nodiscard]] FalconFrame encodeCommand(const FalconCommand& command) noexcept;
[[nodiscard]] FalconFrame encodeReply(const FalconReply& reply) noexcept;
/// Command in a frame as a device may read it: motors beyond their range stay, and unknown bits of
/// the info are left out. Needs isFrame().
[[nodiscard]] FalconCommand readCommand(const FalconFrame& frame) noexcept;
/// Returns nothing for 16 bytes that are no frame, or recognizably one of the other kind.
[[nodiscard]] std::optional<FalconCommand> decodeCommand(const FalconFrame& frame) noexcept;
[[nodiscard]] std::optional<FalconReply> decodeReply(const FalconFrame& frame) noexcept;

/// True if markers, nibbles and info are those of a frame.
[[nodiscard]] bool isFrame(const FalconFrame& frame) noexcept;

/// Finds frames in a stream of bytes that comes in pieces. After lost, doubled or wrong bytes it
/// finds the next complete frame.
class FalconFrameReader {
 public:
  /// Returns the frame that ends with this byte, if one does.
  [[nodiscard]] std::optional<FalconFrame> take(std::uint8_t byte) noexcept;
  /// Forgets the bytes of an incomplete frame.
  void clear() noexcept { size_ = 0; }

  [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
  /// Number of bytes that belonged to no frame.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  void dropToNextStart() noexcept;

  FalconFrame bytes_{};
  std::size_t size_ = 0;
  std::uint64_t frames_ = 0, dropped_ = 0;
};

}  // namespace tandem
