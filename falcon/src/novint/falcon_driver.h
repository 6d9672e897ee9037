#pragma once

#include <cstdint>
#include <optional>

#include "tandem/falcon/falcon_settings.h"
#include "tandem/falcon/falcon_status.h"

#include "novint/falcon_boot.h"
#include "novint/falcon_force_gate.h"
#include "novint/falcon_tracker.h"

namespace tandem {

/// A position with its number. Plain values that threads can copy.
struct FalconReading {
  std::array<double, 3> p{}, v{};  ///< relative to the centre [m], [m/s], along the axes of D
  bool is_valid = false;           ///< the device is ready and the newest reply has a position
  std::uint64_t number = 0;        ///< grows with every reply
};

/// The protocol of the Novint Falcon from bytes to newtons, without I/O, clock or thread. Bytes and
/// time go in, actions for the line come out. The same calls give the same bits.
///
/// The force of every frame has passed the gate. There is no force unless the device is homed and
/// its replies are fresh.
class FalconDriver {
 public:
  /// Throws std::invalid_argument with the value's name for settings out of range. With an empty
  /// `image` only a device with running firmware is usable.
  explicit FalconDriver(const FalconSettings& settings, FirmwareImage image = {});

  /// The line has been opened, or was lost because of `why`.
  void connect(double now) noexcept;
  void disconnect(FalconFault why, double now) noexcept;

  /// Processes received bytes.
  void take(const std::uint8_t* bytes, std::size_t count, double now) noexcept;
  /// Sets the wanted force on the hand [N], at time `now`.
  void command(const Vec3& f_D, double now) noexcept;
  /// Returns the action for the line now.
  [[nodiscard]] LineStep advance(double now) noexcept;

  /// Ramps the force to zero and turns the lights off, whether frames are answered or not. There is
  /// no force until connect().
  void beginStop() noexcept;
  /// True if enough frames without force were sent, or if none can be sent.
  [[nodiscard]] bool hasStopped() const noexcept;

  [[nodiscard]] const FalconReading& reading() const noexcept { return reading_; }
  [[nodiscard]] const FalconStatus& status() const noexcept { return status_; }

 private:
  [[nodiscard]] bool isConversing() const noexcept;
  [[nodiscard]] bool isAtRest() const noexcept;
  [[nodiscard]] bool isTakingForceAway() const noexcept;
  void enterFault(FalconFault fault, double now) noexcept;
  void startBoot(double now) noexcept;
  void startRun(double now) noexcept;
  LineStep advanceBoot(double now) noexcept;
  LineStep advanceRun(double now) noexcept;
  LineStep converse(double now) noexcept;
  LineStep listen(double now) noexcept;
  void excuseHost(double now) noexcept;
  void checkReplies(double now) noexcept;
  void takeReply(const FalconReply& reply, double now) noexcept;
  void noteReply(const FalconReply& reply, double now) noexcept;
  void noteDropped(std::uint64_t dropped) noexcept;
  bool takePosition(const FalconReply& reply, double now) noexcept;
  void updateState(bool has_position, double now) noexcept;
  void publish(bool is_valid) noexcept;
  void sendFrame(LineStep& step, double now) noexcept;
  [[nodiscard]] double findEdgeShare(const Vec3& torques, double now) const noexcept;
  [[nodiscard]] std::uint8_t chooseLights(const Vec3& f_D) const noexcept;

  FalconSettings settings_;
  FalconBoot boot_;
  FalconTracker tracker_;
  FalconKinematics kinematics_;
  FalconForceGate gate_;
  FalconFrameReader frames_;
  FalconStatus status_;
  FalconReading reading_;

  bool boots_ = false, stops_ = false, awaits_reply_ = false, is_excused_ = false;
  int rest_frames_ = 0;                             ///< newest frames without force, saturates at 5
  std::optional<double> boot_at_;                   ///< time to boot again after a failed boot [s]
  double due_ = 0.0, sent_at_ = 0.0;                ///< times of the next and of the last frame [s]
  double expected_at_ = 0.0;                        ///< latest time of the host's next call [s]
  std::optional<double> silent_since_;              ///< first frame since the last usable reply [s]
  std::optional<double> astray_since_;              ///< first homed reply without a position [s]
  double heard_at_ = 0.0;                           ///< last complete reply, usable or not [s]
  std::optional<double> listens_until_, asked_at_;  ///< quiet phase: end, last frame [s]
  double trouble_at_ = 0.0;                         ///< last trouble of the current fault [s]
  std::uint64_t dropped_ = 0;  ///< bytes dropped by the reader up to the last reply

  Vec3 wanted_D_ = Vec3::Zero();
  double wanted_at_ = -1e9;
};

}  // namespace tandem
