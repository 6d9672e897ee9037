#pragma once

#include <array>
#include <cstdint>

#include "tandem/falcon/falcon_settings.h"
#include "tandem/falcon/falcon_status.h"

#include "novint/falcon_frames.h"
#include "novint/firmware_image.h"
#include "novint/line_step.h"

namespace tandem {

/// Reason why a Falcon did not boot.
enum class BootFault : std::uint8_t {
  kNone,
  kNoImage,    ///< the device has no firmware, and no image was given
  kNoAnswer,   ///< the boot loader does not answer its call
  kNoEcho,     ///< the boot loader does not echo, or stops echoing
  kWrongEcho,  ///< the boot loader echoes other bytes
  kNotRunning  ///< the image was loaded, but the firmware gives no reply
};

[[nodiscard]] FalconFault faultOf(BootFault fault) noexcept;

/// Boot sequence of a Falcon, as a state machine without I/O and clock:
///
///     probe at 1.5 MBd ----> a reply: running
///       | none
///       v
///     9600, DTR low, high -> 0A 43 0D <- 0A 44 2C 0D      (the loader's call, repeated)
///     142857, DTR low -----> 41       <- 41               (it measures the speed)
///     image, piece by piece; each byte comes back and is compared
///     1.5 MBd -------------> a command frame <- a reply: running
///
/// The machine searches the stream for the answers. Any failure ends the try; the next one follows
/// after a pause.
class FalconBoot {
 public:
  enum class Phase : std::uint8_t {
    kIdle,
    kProbing,
    kResetting,
    kCalling,
    kTiming,
    kLoading,
    kStarting,
    kPausing,
    kRunning,
    kFailed
  };

  /// With an empty image it can only detect firmware that runs already.
  explicit FalconBoot(FirmwareImage image, const BootSettings& settings = {});

  /// Restarts with the probe.
  void start(double now) noexcept;
  /// Processes received bytes.
  void take(const std::uint8_t* bytes, std::size_t count, double now) noexcept;
  /// Returns the action for the line now; no action when running or failed.
  [[nodiscard]] LineStep advance(double now) noexcept;

  [[nodiscard]] Phase phase() const noexcept { return phase_; }
  /// Fault of the last failed try; final if the phase is kFailed.
  [[nodiscard]] BootFault fault() const noexcept { return fault_; }
  [[nodiscard]] int tries() const noexcept { return tries_; }  ///< tries begun
  /// Bytes of the image echoed correctly in this try.
  [[nodiscard]] std::size_t loaded() const noexcept { return loaded_; }
  [[nodiscard]] std::size_t size() const noexcept { return image_.bytes.size(); }

 private:
  void enter(Phase phase, double now) noexcept;
  void fail(BootFault fault, double now) noexcept;
  void takeByte(std::uint8_t byte, double now) noexcept;
  void takeEcho(std::uint8_t byte, double now) noexcept;
  void onTimeUp(double now) noexcept;
  LineStep makeEntryStep(double now) noexcept;
  LineStep makeStep(double now) noexcept;
  void sendPiece(LineStep& step) noexcept;

  FirmwareImage image_;
  BootSettings settings_;
  Phase phase_ = Phase::kIdle;
  BootFault fault_ = BootFault::kNone;
  int tries_ = 0, calls_ = 0;
  bool has_entered_ = false;  ///< the line is set for this phase
  double until_ = 0.0;        ///< deadline of the phase or of the piece [s]
  double send_at_ = 0.0;      ///< time of the next call or frame [s]
  std::size_t loaded_ = 0, sent_ = 0;
  std::array<std::uint8_t, 4> last_{};  ///< last received bytes, the newest last
  FalconFrameReader frames_;
};

}  // namespace tandem
