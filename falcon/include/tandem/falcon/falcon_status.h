#pragma once

#include <array>
#include <cstdint>

#pragma GCC visibility push(default)
namespace tandem {

/// Buttons of the grip; several may be pressed.
enum FalconButton : std::uint8_t {
  kPlusButton = 0x01,
  kForwardButton = 0x02,
  kCentreButton = 0x04,
  kMinusButton = 0x08
};

enum class FalconState : std::uint8_t {
  kClosed,   ///< no line to the device
  kBoot,     ///< looking for running firmware, or calling the boot loader
  kLoading,  ///< sending the firmware to the device
  kUnhomed,  ///< firmware runs; the user must pull the grip out and push it in
  kReady,    ///< positions are valid, force is rendered
  kFault     ///< something is wrong: no force; ends by itself when the cause is gone
};

/// Cause of the last loss of force. It stays set until the device is ready again.
enum class FalconFault : std::uint8_t {
  kNone,
  kCannotOpen,      ///< the line cannot be opened
  kUnplugged,       ///< the line went away
  kNoFirmware,      ///< the device has no firmware, and no image was given
  kNoBootLoader,    ///< the boot loader does not answer
  kNoBootEcho,      ///< the boot loader stopped echoing the image
  kWrongBootEcho,   ///< the boot loader echoed other bytes
  kNotRunning,      ///< the image was loaded, but no firmware answers
  kNoReply,         ///< frames are not answered
  kDamagedReplies,  ///< the received bytes are no valid reply
  kFirmwareLost,    ///< no reply for long, as after a power cycle; boots again
  kHomingLost,      ///< a leg lost its reference angle
  kOutOfReach       ///< the legs report a pose that the mechanism cannot reach
};

/// Name of a state in one word, for tables: "ready".
[[nodiscard]] const char* nameOf(FalconState state) noexcept;
/// Fault and remedy in one line, without the device's name.
[[nodiscard]] const char* textOf(FalconFault fault) noexcept;

/// Round-trip times from a frame to its reply.
struct FalconRoundTrips {
  static constexpr double kBin = 0.0005;  ///< width of a bin [s]
  std::uint64_t count = 0;
  double least = 0.0, sum = 0.0, most = 0.0;  ///< [s]
  std::array<std::uint64_t, 20> bins{};  ///< counts per kBin; the last bin holds all longer times

  void add(double time) noexcept;
  [[nodiscard]] double mean() const noexcept {
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
  }
};

/// Status and counters of the device. Plain values that threads can copy.
struct FalconStatus {
  FalconState state = FalconState::kClosed;
  FalconFault fault = FalconFault::kNone;
  std::uint8_t homed = 0;                ///< bit i: leg i + 1 has found its index
  std::uint8_t buttons = 0;              ///< bits of FalconButton
  std::array<std::int16_t, 3> counts{};  ///< encoder counts, homed or not
  std::array<double, 3> force_D{};       ///< force sent last [N]
  std::uint32_t loaded = 0, image = 0;   ///< firmware bytes loaded, and size of the image

  std::uint64_t frames = 0;         ///< frames sent
  std::uint64_t replies = 0;        ///< complete replies
  std::uint64_t late = 0;           ///< replies that took longer than two frame periods
  std::uint64_t missing = 0;        ///< frames without a reply
  std::uint64_t resyncs = 0;        ///< times that bytes were dropped to find a reply
  std::uint64_t dropped_bytes = 0;  ///< bytes that belonged to no reply
  std::uint64_t short_replies = 0;  ///< resyncs in which 1 to 15 bytes came instead of 16
  std::uint64_t jumps = 0;          ///< positions too far from the last one to accept at once
  std::uint64_t faults = 0;         ///< entries into the state kFault
  std::uint64_t boots = 0;          ///< times that the firmware was loaded, or found running
  std::uint64_t opened = 0;         ///< times that the line was opened
  FalconRoundTrips round_trips;
  std::array<char, 160> open_error{};  ///< why the line could not be opened; zero-terminated
};

}  // namespace tandem
#pragma GCC visibility pop
