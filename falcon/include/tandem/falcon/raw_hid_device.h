#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "tandem/falcon/falcon_settings.h"
#include "tandem/falcon/haptic_device.h"
#include "tandem/falcon/hid_port.h"

#pragma GCC visibility push(default)
namespace tandem {

class HidStream;

namespace falcon_detail {
class RawHidClient;
}

/// State that the device reports (docs/hid.md).
struct RawHidState {
  std::uint16_t number = 0;              ///< report number: grows by one per report, wraps
  std::array<std::int16_t, 3> counts{};  ///< of the legs' encoders, see angleOfCounts()
  std::uint8_t homed = 0;                ///< bit i: leg i + 1 has found its index
  std::uint8_t buttons = 0;
  std::uint32_t time_us = 0;  ///< the device's clock when the counts were taken, wraps
  [[nodiscard]] bool isHomed() const noexcept { return homed == 7; }
};

struct RawHidSettings {
  FalconGeometry geometry;
  double max_force = 8.0;                 ///< [N], > 0, at most 8: the limit of a Falcon's motors
  double ramp_in = 0.5;                   ///< time to full force after a start or a fault [s], >= 0
  Vec3 origin_D = Vec3(0.0, 0.0, 0.125);  ///< point of the device that is W's origin [m]
  Quat q_WD = Quat(1.0, 0.0, 0.0, 0.0);   ///< rotation from the device's frame to W
  HidStreamSettings stream{1e-3};         ///< write_period: > 0, at most 10 ms
};

/// Status of a raw HID device.
struct RawHidStatus {
  RawHidState state;
  bool is_connected = false;
  std::uint64_t lost = 0;  ///< reports lost, counted by their numbers
  std::string name, trouble;
  HidStreamCounters counters;
};

/// A haptic device with the Falcon's legs that speaks the protocol of raw_hid_report.h.
///
/// It is safe without help from the caller. It renders force only if all legs found their index
/// and the counts are in the arms' range. The last new report must be at most 20 ms old. The force
/// ends 50 ms after the last write() and for a non-finite force. Force is at most max_force and
/// changes by at most 2 N per millisecond and per report. This slew also holds on the way to zero:
/// 4 ms from 8 N, then motors off. After a start or any of these faults the force returns over
/// ramp_in and one sample is invalid. On closing the force also ramps to zero, then the motors are
/// off.
///
/// The writing thread does all this by its own clock, even if the haptic thread stops. The device
/// must have its own watchdog (docs/hid.md). read() and write() are wait-free and do not allocate;
/// one thread uses them.
class RawHidDevice final : public HapticDevice {
 public:
  static constexpr double kFresh = 0.020;    ///< oldest usable report [s]
  static constexpr double kCommand = 0.050;  ///< lifetime of a written force [s]

  /// Throws what `open` throws. Throws std::invalid_argument with the value's name for bad
  /// settings.
  explicit RawHidDevice(HidOpener open, const RawHidSettings& settings = {});
  ~RawHidDevice() override;

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;
  /// Not valid unless homed, fresh and within reach of the legs.
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  /// Uses the grip's pose of the last read().
  void write(const Vec3& f_W) noexcept override;

  /// For the thread that reads. Takes a lock and allocates.
  [[nodiscard]] RawHidStatus status();

 private:
  struct Grip;

  void takeState(const RawHidState& state) noexcept;

  RawHidSettings settings_;
  DeviceCapabilities capabilities_;

  std::unique_ptr<Grip> grip_;
  Vec3 v_D_ = Vec3::Zero();
  double device_time_ = 0.0;    ///< device clock at the pose, without wraps [s]
  std::uint32_t time_us_ = 0;   ///< device clock at the pose, wraps [us]
  std::uint64_t heard_ = 0;     ///< reports seen
  std::uint64_t closures_ = 0;  ///< the client's count of closures at the last read
  double heard_at_ = 0.0;       ///< time told to read() when a new report was seen [s]
  bool is_usable_ = false;      ///< the last sample was valid

  std::unique_ptr<falcon_detail::RawHidClient> client_;  // outlives the stream
  std::unique_ptr<HidStream> stream_;
};

/// Address of such a device.
inline const HidAddress kRawHid{0x16C0, 0x0486, 0xFFAB, 0x0200, -1, "", ""};

}  // namespace tandem
#pragma GCC visibility pop
