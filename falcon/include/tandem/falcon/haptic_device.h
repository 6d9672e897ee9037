#pragma once

#include <limits>
#include <string>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// What a haptic device can do; the site limits itself to it.
struct DeviceCapabilities {
  std::string name;
  int degrees_of_freedom = 3;                                  ///< rendered forces
  double max_force = std::numeric_limits<double>::infinity();  ///< [N], norm
  /// Fastest change of the force that the hand should feel [N/s].
  double max_slew = std::numeric_limits<double>::infinity();
  double max_stiffness = std::numeric_limits<double>::infinity();  ///< [N/m] that still feels calm
  Vec3 workspace = Vec3::Constant(std::numeric_limits<double>::infinity());  ///< half extents [m]
  /// read() is exact at any moment, also between two ticks: packets then carry the state of their
  /// own moment instead of the last tick's, carried on. No real device is.
  bool is_continuous = false;
};

/// One reading of a device.
struct DeviceSample {
  PointState hip;      ///< haptic interface point, in W
  bool valid = false;  ///< false: the device gave nothing usable; the site then renders no force
};

/// A haptic device: read the hand's position, render a force. Non-blocking, `noexcept`, no
/// allocation: called from the thread that ticks the site.
class HapticDevice {
 public:
  virtual ~HapticDevice() = default;
  [[nodiscard]] virtual const DeviceCapabilities& capabilities() const noexcept = 0;

  /// State of the haptic interface point at time `now` [s].
  [[nodiscard]] virtual DeviceSample read(double now) noexcept = 0;

  /// Force on the hand, in W [N]; held by the device until the next write. Non-finite means zero.
  virtual void write(const Vec3& f_W) noexcept = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
