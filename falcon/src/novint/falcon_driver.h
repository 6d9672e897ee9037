#pragma once

#include <cstdint>
#include <optional>

#include "tandem/falcon/falcon_settings.h"
#include "tandem/falcon/falcon_status.h"

#include "novint/falcon_boot.h"
#include "novint/falcon_force_gate.h"
#include "novint/falcon_tracker.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A position with its number; plain values, to be copied between threads.
struct FalconReading {
  std::array<double, 3> p{}, v{};  ///< from the centre [m], [m/s], along the axes of D
  bool is_valid = false;           ///< ready, and of the newest reply
  std::uint64_t number = 0;        ///< grows with every reply
};

/// The Novint Falcon from bytes to newtons, without I/O, clock or thread: bytes and time come in,
/// what to do with the line goes out. Same calls, same bits.
///
/// Every frame's force has passed the gate, whatever was asked for: no force unless the device is
/// homed and its replies are fresh.
class FalconDriver {
 public:
  /// Throws std::invalid_argument, naming the value, for settings out of range. `image` may be
  /// empty: then it can use only a device whose firmware runs.
  explicit FalconDriver(const FalconSettings& settings, FirmwareImage image = {});

  /// The line has been opened, or is gone for a reason.
  void connect(double now) noexcept;
  void disconnect(FalconFault why, double now) noexcept;

  /// Bytes that have come.
  void take(const std::uint8_t* bytes, std::size_t count, double now) noexcept;
  /// Force on the hand, asked for now [N].
  void command(const Vec3& f_D, double now) noexcept;
  /// What to do with the line now.
  [[nodiscard]] LineStep advance(double now) noexcept;

  /// From now on, until connect(), there is no force: it goes frame by frame, whether they are
  /// answered or not, and the lights go out.
  void beginStop() noexcept;
  /// Enough frames without force have been sent, or none can be.
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
  [[nodiscard]] std::uint8_t chooseLights(const Vec3& f_D) const noexcept;

  FalconSettings settings_;
  FalconBoot boot_;
  FalconTracker tracker_;
  FalconForceGate gate_;
  FalconFrameReader frames_;
  FalconStatus status_;
  FalconReading reading_;

  bool boots_ = false, stops_ = false, awaits_reply_ = false, is_excused_ = false;
  int rest_frames_ = 0;                 ///< the newest ones, without force; enough is enough
  std::optional<double> boot_at_;       ///< again, after a boot that failed [s]
  double due_ = 0.0, sent_at_ = 0.0;    ///< the next frame; the last one [s]
  double expected_at_ = 0.0;            ///< the next look of the host, at the latest [s]
  std::optional<double> silent_since_;  ///< the first frame without a reply of use, since one [s]
  std::optional<double> astray_since_;  ///< replies of homed legs that are no position [s]
  double heard_at_ = 0.0;               ///< the last whole reply, of use or not [s]
  std::optional<double> listens_until_, asked_at_;  ///< after replies went missing [s]
  double trouble_at_ = 0.0;                         ///< the last of a fault [s]
  std::uint64_t dropped_ = 0;                       ///< of the reader, at the last reply

  Vec3 wanted_D_ = Vec3::Zero();
  double wanted_at_ = -1e9;
};

}  // namespace tandem
#pragma GCC visibility pop
