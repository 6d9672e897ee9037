#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "tandem/falcon/haptic_device.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Limits of a GuardedDevice. Smaller limits of the device itself take precedence.
struct GuardSettings {
  double max_force = 8.0;    ///< [N], norm, > 0; about the force of a Falcon
  double max_slew = 2000.0;  ///< fastest change of the force [N/s], > 0: 2 N in a millisecond
  double ramp = 0.5;         ///< time from zero to full force after a cut [s], >= 0
};

/// Reason why a GuardedDevice takes the force away.
enum class GuardCut : std::uint8_t {
  kNotValid,   ///< no usable position: not homed, unplugged, not finite
  kDeadMan,    ///< the dead-man switch is released
  kStale,      ///< no write for 50 ms
  kLate,       ///< more than 50 ms between two reads; the device held its force meanwhile
  kTime,       ///< the time is not finite, runs back, or stands still for 50 reads
  kNotFinite,  ///< a non-finite force was written
};
inline constexpr std::size_t kGuardCuts = 6;

/// State and counters of a GuardedDevice.
struct GuardStatus {
  Vec3 force = Vec3::Zero();  ///< force on the device now [N]
  double share = 0.0;         ///< fraction of the force that the ramp lets through, 0 to 1
  bool is_cut = true;  ///< as of the last read or write; true before the first valid position
  std::uint64_t clamped = 0;  ///< writes above max_force
  std::uint64_t slewed = 0;   ///< writes that changed the force faster than max_slew
  std::uint64_t ramped = 0;   ///< writes that the ramp reduced
  std::array<std::uint64_t, kGuardCuts> cuts{};  ///< number of cuts by GuardCut
};

/// Last safety guard before a device; it trusts no caller. Each write passes these stages:
///
///   not finite: cut  ->  no longer than max_force  ->  ramp  ->  rises no faster than max_slew
///
/// A force may fall at once, so that the guard never renders one whose cause has gone. The first
/// three stages keep the direction of the force. A cut (GuardCut) takes the force to zero; the ramp
/// restarts when the cut ends. The force is zero within 100 ms of any fault if read() is called at
/// least every 10 ms. Usually it is zero within 4 ms of detection. If the loop stops calling, the
/// device's own watchdog must act.
///
/// The slew limit uses the time that read() is told, not the number of calls. A change may be at
/// most max_slew times the time since the last change. A write counts at most 2 ms of it, so a late
/// loop cannot save up time for a jump. A cut counts all of it, and takes at most 30 ms from
/// max_force to zero even if max_slew is slower. Only an invalid time removes the force at once.
///
/// Call read(), then write() with the resulting force. Real-time safe except for construction. One
/// thread uses it; any thread may use the dead-man switch. The destructor sets the device's force
/// to zero.
class GuardedDevice final : public HapticDevice {
 public:
  /// Throws std::invalid_argument if there is no device or a setting is out of range.
  explicit GuardedDevice(std::unique_ptr<HapticDevice> device, const GuardSettings& settings = {});
  ~GuardedDevice() override;
  GuardedDevice(const GuardedDevice&) = delete;
  GuardedDevice& operator=(const GuardedDevice&) = delete;

  /// Capabilities of the device within the guard's limits.
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return capabilities_;
  }
  /// Sample of the device; not valid unless finite.
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f) noexcept override;
  /// A torque has the force's ramp and cuts, and the device's limit. A non-finite one cuts both.
  void writeTorque(const Vec3& t) noexcept override;

  /// Sets the dead-man switch: held (true, the initial state) or released. Acts from the next read
  /// on. For any thread.
  void holdDeadMan(bool is_held) noexcept { is_held_.store(is_held, std::memory_order_relaxed); }

  /// For the thread that calls read() and write().
  [[nodiscard]] const GuardStatus& status() const noexcept { return status_; }

 private:
  void takeTime(double now) noexcept;
  void letGo() noexcept;
  void cut(GuardCut reason) noexcept;
  void fade() noexcept;
  void send(const Vec3& force) noexcept;

  std::unique_ptr<HapticDevice> device_;
  DeviceCapabilities capabilities_;
  double ramp_, fade_slew_;
  GuardStatus status_;
  GuardCut reason_ = GuardCut::kNotValid;  ///< reason of the current cut
  std::atomic<bool> is_held_{true};
  double now_ = 0.0, passed_ = 0.0;  ///< time of the last read, and since the one before [s]
  double unused_ = 0.0;              ///< time not yet used for a change of force [s]
  double last_write_ = 0.0;          ///< time of the last write [s]
  Vec3 v_W_ = Vec3::Zero();          ///< velocity of the last valid sample [m/s]
  double fade_energy_ = 0.0;         ///< energy that this cut's fade gave the hand [J]
  bool was_read_ = false, is_time_wrong_ = false;
  int standing_ = 0;  ///< reads in a row whose time did not advance
};

}  // namespace tandem
#pragma GCC visibility pop
