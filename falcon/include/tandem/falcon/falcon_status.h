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
  kClosed,   ///< no line to it
  kBoot,     ///< looking for running firmware, or calling the boot loader
  kLoading,  ///< the firmware goes into it
  kUnhomed,  ///< runs; the user has yet to pull the grip out and push it in
  kReady,    ///< positions are true, force is rendered
  kFault     ///< something is wrong: no force; it recovers by itself when the cause is gone
};

/// Why there is or was no force; the newest stays to be read until the device is ready again.
enum class FalconFault : std::uint8_t {
  kNone,
  kCannotOpen,      ///< the line cannot be opened
  kUnplugged,       ///< the line went away
  kNoFirmware,      ///< it has no firmware, and no image was given
  kNoBootLoader,    ///< the boot loader does not answer
  kNoBootEcho,      ///< the boot loader stopped echoing the image
  kWrongBootEcho,   ///< the boot loader echoed something else
  kNotRunning,      ///< the image was loaded, and nothing runs
  kNoReply,         ///< frames are not answered
  kDamagedReplies,  ///< what comes is no reply
  kFirmwareLost,    ///< no reply for long, as after a power cycle: it is booted again
  kHomingLost,      ///< a leg does not know its angle any more
  kOutOfReach       ///< the legs report what the mechanism cannot do
};

/// One word, for tables: "ready".
[[nodiscard]] const char* nameOf(FalconState state) noexcept;
/// What is wrong and what to do, one line without the device's name.
[[nodiscard]] const char* textOf(FalconFault fault) noexcept;

/// Time from a frame to its reply.
struct FalconRoundTrips {
  static constexpr double kBin = 0.0005;  ///< [s]
  std::uint64_t count = 0;
  double least = 0.0, sum = 0.0, most = 0.0;  ///< [s]
  std::array<std::uint64_t, 20> bins{};       ///< of kBin each; the last holds all above

  void add(double time) noexcept;
  [[nodiscard]] double mean() const noexcept {
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
  }
};

/// How the device does; plain values, to be copied between threads.
struct FalconStatus {
  FalconState state = FalconState::kClosed;
  FalconFault fault = FalconFault::kNone;
  std::uint8_t homed = 0;                ///< bit i: leg i + 1
  std::uint8_t buttons = 0;              ///< of FalconButton
  std::array<std::int16_t, 3> counts{};  ///< of the encoders, homed or not
  std::array<double, 3> force_D{};       ///< sent last [N]
  std::uint32_t loaded = 0, image = 0;   ///< of the firmware, while it is loaded [bytes]

  std::uint64_t frames = 0;         ///< sent
  std::uint64_t replies = 0;        ///< whole ones
  std::uint64_t late = 0;           ///< replies that took longer than two frames' time
  std::uint64_t missing = 0;        ///< frames given up
  std::uint64_t resyncs = 0;        ///< times that bytes had to be dropped to find a reply
  std::uint64_t dropped_bytes = 0;  ///< that belonged to no reply
  std::uint64_t short_replies = 0;  ///< resyncs in which 1 to 15 bytes came instead of 16
  std::uint64_t jumps = 0;          ///< positions too far from the last to be believed at once
  std::uint64_t faults = 0;         ///< times that it went into the state kFault
  std::uint64_t boots = 0;          ///< times that the firmware was found running or loaded
  std::uint64_t opened = 0;         ///< times that the line was opened
  FalconRoundTrips round_trips;
  std::array<char, 160> open_error{};  ///< why the line could not be opened; ends with 0
};

}  // namespace tandem
#pragma GCC visibility pop
