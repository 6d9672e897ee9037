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

/// What the device says of itself (docs/hid.md).
struct RawHidState {
  std::uint16_t number = 0;              ///< one more in every report, wraps
  std::array<std::int16_t, 3> counts{};  ///< of the legs' encoders, as angleOfCounts() has them
  std::uint8_t homed = 0;                ///< bit i: leg i + 1 has found its index
  std::uint8_t buttons = 0;
  std::uint32_t time_us = 0;  ///< the device's clock when the counts were taken, wraps
  [[nodiscard]] bool isHomed() const noexcept { return homed == 7; }
};

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
/// Safe without anybody's help: no force unless all legs have found their index, the counts are
/// those of arms in their range, and the last report with a new number is at most 20 ms old; none
/// from 50 ms after the last write() on; none for what is not finite. Force is never more than
/// max_force and changes by at most 2 N in a millisecond and a report, also on the way to zero
/// (4 ms from 8 N, then motors off). After a start, and after any of these faults, be it for one
/// report, it comes back over ramp_in, and one sample is not valid. The last words are the same
/// way to motors off.
///
/// All this is done by the thread that writes and by its own clock, whatever becomes of the haptic
/// thread; the device must have a watchdog of its own (docs/hid.md). read() and write() are
/// wait-free and do not allocate; one thread uses them.
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
  /// For the grip as read() has last seen it.
  void write(const Vec3& f_W) noexcept override;

  /// From the thread that reads; takes a lock and allocates.
  [[nodiscard]] RawHidStatus status();

 private:
  struct Grip;

  void takeState(const RawHidState& state) noexcept;

  RawHidSettings settings_;
  DeviceCapabilities capabilities_;

  std::unique_ptr<Grip> grip_;
  Vec3 v_D_ = Vec3::Zero();
  double device_time_ = 0.0;    ///< of the pose, by the device's clock, from some moment [s]
  std::uint32_t time_us_ = 0;   ///< of the pose, by the device's clock
  std::uint64_t heard_ = 0;     ///< reports seen
  std::uint64_t closures_ = 0;  ///< of the client, that are known here
  double heard_at_ = 0.0;       ///< by the clock that read() is told
  bool is_usable_ = false;      ///< the last sample was valid

  std::unique_ptr<falcon_detail::RawHidClient> client_;  // outlives the stream
  std::unique_ptr<HidStream> stream_;
};

/// Where such a device is found.
inline const HidAddress kRawHid{0x16C0, 0x0486, 0xFFAB, 0x0200, -1, "", ""};

}  // namespace tandem
#pragma GCC visibility pop
