#pragma once

#include <memory>
#include <string>

#include "tandem/falcon/falcon_kinematics.h"
#include "tandem/falcon/haptic_device.h"
#include "tandem/falcon/hid_stream.h"
#include "tandem/falcon/raw_hid_report.h"
#include "tandem/falcon/velocity_estimator.h"

namespace tandem {

namespace falcon_detail {
class RawHidClient;
}

struct RawHidSettings {
  FalconGeometry geometry;
  double max_force = 8.0;  ///< [N], above 0, at most 8: what a Falcon's motors can do
  double ramp_in = 0.5;    ///< until the full force is given after a start or a fault [s], >= 0
  Vec3 origin_D = Vec3(0.0, 0.0, 0.125);  ///< the place in the device that is W's origin [m]
  Quat q_WD = Quat(1.0, 0.0, 0.0, 0.0);   ///< from the device's frame to W
  HidStreamSettings stream{1e-3};         ///< write_period: above 0, at most 10 ms
};

/// How a raw HID device is.
struct RawHidStatus {
  RawHidState state;
  bool is_connected = false;
  std::uint64_t lost = 0;  ///< reports of the device that did not come, by their numbers
  std::string name, trouble;
  HidStreamCounters counters;
};

/// A haptic device with the Falcon's legs that speaks raw_hid_report.h.
///
/// Safe without anybody's help: no force unless all legs have found their index and the last report
/// with a new number is at most 20 ms old; none 50 ms after the last write(); none for what is not
/// finite; never more than max_force; full force only after ramp_in; motors off as the last word.
/// The thread that writes looks after both ages by its own clock, whatever becomes of the haptic
/// thread; the device must do the same (docs/hid.md). read() and write() are wait-free and do not
/// allocate; one thread uses them.
class RawHidDevice final : public HapticDevice {
 public:
  static constexpr double kFresh = 0.020;    ///< [s]
  static constexpr double kCommand = 0.050;  ///< [s]

  /// Throws what `open` throws; std::invalid_argument, naming the value, for bad settings.
  explicit RawHidDevice(HidOpener open, const RawHidSettings& settings = {});
  ~RawHidDevice() override;

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;
  /// Not valid unless homed, fresh and within reach of the legs.
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f_W) noexcept override;

  /// From the thread that reads; takes a lock and allocates.
  [[nodiscard]] RawHidStatus status();

 private:
  void takeState(const RawHidState& state) noexcept;
  [[nodiscard]] Vec3 limit(const Vec3& f_W) const noexcept;

  RawHidSettings settings_;
  DeviceCapabilities capabilities_;
  FalconKinematics kinematics_;

  std::optional<FalconPose> pose_;  ///< of the newest report; nothing: unusable
  AdaptiveWindow count_rates_ = makeUsualVelocityEstimator();
  Vec3 v_D_ = Vec3::Zero();
  double device_time_ = 0.0;           ///< of the pose, by the device's clock, from some moment [s]
  std::uint32_t time_us_ = 0;          ///< of the pose, by the device's clock
  std::uint64_t heard_ = 0;            ///< reports seen
  double now_ = 0.0, heard_at_ = 0.0;  ///< by the clock that read() is told
  std::optional<double> valid_since_;

  std::unique_ptr<falcon_detail::RawHidClient> client_;  // outlives the stream
  std::unique_ptr<HidStream> stream_;
};

/// Where such a device is found.
inline const HidAddress kRawHid{0x16C0, 0x0486, 0xFFAB, 0x0200, -1, "", ""};

}  // namespace tandem
