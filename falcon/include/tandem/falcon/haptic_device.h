#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Capabilities of a haptic device. The site stays within them.
struct DeviceCapabilities {
  std::string name;
  int degrees_of_freedom = 3;  ///< number of rendered force components
  double max_force = std::numeric_limits<double>::infinity();  ///< [N], norm
  double max_torque = 0.0;                                     ///< [N m], norm; 0: renders none
  /// Fastest change of the force that the hand should feel [N/s].
  double max_slew = std::numeric_limits<double>::infinity();
  double max_stiffness = std::numeric_limits<double>::infinity();  ///< stable stiffness [N/m]
  Vec3 workspace = Vec3::Constant(std::numeric_limits<double>::infinity());  ///< half extents [m]
  /// True if read() is exact at any time, also between two ticks. Packets then carry the state of
  /// their own moment, not the extrapolated state of the last tick. No real device is continuous.
  bool is_continuous = false;
};

/// One reading of a device.
struct DeviceSample {
  PointState hip;      ///< haptic interface point, in W
  bool valid = false;  ///< false: no usable reading; the site then renders no force
  std::optional<WristState> wrist = {};  ///< empty: the device does not turn
  std::uint32_t buttons = 0;             ///< bit i: button i is pressed
};

/// A haptic device: reads the hand's position and renders a force. Calls are non-blocking,
/// `noexcept` and do not allocate. The thread that ticks the site makes them.
class HapticDevice {
 public:
  virtual ~HapticDevice() = default;
  [[nodiscard]] virtual const DeviceCapabilities& capabilities() const noexcept = 0;

  /// State of the haptic interface point at time `now` [s].
  [[nodiscard]] virtual DeviceSample read(double now) noexcept = 0;

  /// Sets the force on the hand, in W [N]. The device holds it until the next write. A non-finite
  /// force means zero.
  virtual void write(const Vec3& f_W) noexcept = 0;

  /// Sets the torque on the hand, in W [N m], as write() sets the force. Devices that render none
  /// ignore it.
  virtual void writeTorque(const Vec3& /*t_W*/) noexcept {}
};

}  // namespace tandem
#pragma GCC visibility pop
