#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "tandem/falcon/haptic_device.h"

#pragma GCC visibility push(default)
namespace tandem {

/// What a GuardedDevice holds its device to. The device's own capabilities count where smaller.
struct GuardSettings {
  double max_force = 8.0;    ///< [N], norm, > 0; about what a Falcon gives
  double max_slew = 2000.0;  ///< fastest change of the force [N/s], > 0: 2 N in a millisecond
  double ramp = 0.5;         ///< from nothing to the whole force after a cut [s], >= 0
};

/// Why a GuardedDevice takes its device's force away.
enum class GuardCut : std::uint8_t {
  kNotValid,   ///< no usable position: not homed, unplugged, not finite
  kDeadMan,    ///< the dead-man switch is let go
  kStale,      ///< nobody has written for 50 ms
  kLate,       ///< more than 50 ms between two reads; the force was held all the while
  kTime,       ///< the time is not finite, runs back, or stands for 50 reads
  kNotFinite,  ///< a force that is no number was written
};
inline constexpr std::size_t kGuardCuts = 6;

/// What a GuardedDevice has done.
struct GuardStatus {
  Vec3 force = Vec3::Zero();  ///< as the device has it now [N]
  double share = 0.0;         ///< of the force that the ramp lets through, 0 to 1
  bool is_cut = true;         ///< as of the last read or write; at first there is no position
  std::uint64_t clamped = 0;  ///< writes beyond the greatest force
  std::uint64_t slewed = 0;   ///< writes that would have changed it too fast
  std::uint64_t ramped = 0;   ///< writes that the ramp made smaller
  std::array<std::uint64_t, kGuardCuts> cuts{};  ///< how often each began, by GuardCut
};

/// The last guard of a hand before a device, which trusts nothing that is above it. Each write goes
/// through
///
///   not finite: cut  ->  no longer than max_force  ->  ramp  ->  no faster than max_slew
///
/// with the direction of the force kept by the first three. A cut (GuardCut) takes the force to
/// zero and begins the ramp anew when it is over. Zero is reached within 100 ms of whatever goes
/// wrong, as long as read() is called every 10 ms at least; usually within 4 ms of its being seen.
/// A loop that calls no more leaves the force to the device's own watchdog.
///
/// Slew counts the time that read() tells, not the calls: a change may be max_slew times the time
/// since the last one, of which a write counts 2 ms at most, so that a late loop saves nothing up
/// for a jump. A cut counts all of it, and goes as fast as max_force in 30 ms if max_slew is
/// slower. Only a time that makes no sense takes the force away at once.
///
/// Call read(), then write() with the force of it. Real-time safe but for its making; one thread,
/// and any for the dead-man switch. The device's force is zero when this is destroyed.
class GuardedDevice final : public HapticDevice {
 public:
  /// Throws std::invalid_argument for no device or settings out of range.
  explicit GuardedDevice(std::unique_ptr<HapticDevice> device, const GuardSettings& settings = {});
  ~GuardedDevice() override;
  GuardedDevice(const GuardedDevice&) = delete;
  GuardedDevice& operator=(const GuardedDevice&) = delete;

  /// The device's, with the guard's own limits.
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return capabilities_;
  }
  /// The device's, not valid unless finite.
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f) noexcept override;

  /// The dead-man switch: held (true, as at first) or let go; from the next read on. From any
  /// thread.
  void holdDeadMan(bool is_held) noexcept { is_held_.store(is_held, std::memory_order_relaxed); }

  /// For the thread that reads and writes.
  [[nodiscard]] const GuardStatus& status() const noexcept { return status_; }

 private:
  void takeTime(double now) noexcept;
  void cut(GuardCut reason) noexcept;
  void fade() noexcept;
  void send(const Vec3& wanted, double most_change) noexcept;

  std::unique_ptr<HapticDevice> device_;
  DeviceCapabilities capabilities_;
  double ramp_, fade_slew_;
  GuardStatus status_;
  GuardCut reason_ = GuardCut::kNotValid;  ///< of the cut, while there is one
  std::atomic<bool> is_held_{true};
  double now_ = 0.0, passed_ = 0.0;  ///< of the last read; since the one before [s]
  double unused_ = 0.0;              ///< time that has not gone into a change yet [s]
  double last_write_ = 0.0;          ///< [s]
  bool was_read_ = false, is_time_wrong_ = false;
  int standing_ = 0;  ///< reads in a row that told no later time
};

}  // namespace tandem
#pragma GCC visibility pop
