#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tandem/falcon/haptic_device.h"

#pragma GCC visibility push(default)
namespace tandem {

/// What a simulated user's hand does to the device's handle.
class Hand {
 public:
  virtual ~Hand() = default;

  /// Force of the hand on the handle at time `t` [s], in W [N], with the handle at `handle`.
  /// Pure, real-time safe, finite for a finite time and state.
  [[nodiscard]] virtual Vec3 computeForce(double t, const PointState& handle) const noexcept = 0;
};

/// The paper's commanded constant force F_h (Li & Constantinescu 2009, section IV).
/// Throws std::invalid_argument for a force that is not finite.
[[nodiscard]] std::unique_ptr<Hand> makeConstantHand(const Vec3& f_W);

/// F(t) = f_W sin(2 pi frequency t + phase), frequency in [Hz], phase in [rad].
/// Throws std::invalid_argument for a value that is not finite or a frequency below zero.
[[nodiscard]] std::unique_ptr<Hand> makeSineHand(const Vec3& f_W, double frequency, double phase);

/// One stretch of a hand's way: be at `p_W` at time `t` [s].
struct Waypoint {
  double t = 0.0;
  Vec3 p_W = Vec3::Zero();
};

/// A hand that moves from waypoint to waypoint by minimum-jerk strokes (Flash & Hogan 1985), and
/// holds the handle by a spring-damper: f = K (p_ref - p) + B (v_ref - v). Before the first and
/// after the last waypoint it rests there. Over a stroke of length d and duration T, with u in
/// 0..1:
///
///   p_ref = p_0 + d (10 u^3 - 15 u^4 + 6 u^5)      v_ref = d/T 30 u^2 (1 - u)^2
///
/// Throws std::invalid_argument, naming the value, for no waypoint, times that do not grow, gains
/// below zero or anything not finite.
[[nodiscard]] std::unique_ptr<Hand> makeMinimumJerkHand(std::vector<Waypoint> waypoints,
                                                        double stiffness, double damping);

/// A recorded force over time, linear between rows, held before the first and after the last. The
/// file's first line is the header `t,force_x,force_y,force_z`; lines may end in LF or CRLF. Reads
/// the whole file here; the hand itself does no I/O. Throws tandem::Error naming file, line and
/// what is wrong (missing file or column, text that is no number, times that do not grow, not
/// finite).
[[nodiscard]] std::unique_ptr<Hand> makeRecordedHand(const std::string& csv_path);

/// A mass with damping in a simulated hand, sampled at the haptic rate.
struct SimulatedDeviceSettings {
  double mass = 0.1;                ///< m_h of the handle [kg], > 0; higher moves more slowly
  double damping = 0.5;             ///< b_dev, the device's own friction [N s/m], >= 0; 0: none
  Vec3 start_W = Vec3::Zero();      ///< where the handle rests at t = 0 [m]
  std::optional<Vec3> guide;        ///< unit vector: a slot that leaves the handle this line only
  double encoder_resolution = 0.0;  ///< position is read in steps of this [m]; 0: exact
  double max_force =
      std::numeric_limits<double>::infinity();  ///< motors saturate, direction kept [N], >= 0
};

/// The device of eqs (1), (2): m_h x'' + b_dev x' = F_hand + f_W, with f_W the rendered force of
/// the last write. Source: Li & Constantinescu 2009.
///
/// read(now) moves the handle from the last read to `now` under that force, held constant as a real
/// device does: exact to rounding for a constant hand, any damping and any grouping of the reads;
/// second order in the sub-step (0.25 ms at 1 kHz) for other hands, stable for a hand's stiffness
/// below 4 m / sub-step^2. Time does not run back: an earlier or non-finite `now` moves nothing.
///
/// A guide is a frictionless bilateral slot: the motion is one scalar along it, so nothing creeps
/// off the line. An encoder counts displacement from the start along each free axis (W's three, or
/// the guide); the velocity is then the first difference of counted positions over the interval.
/// Same calls, same bits. Not thread safe: read and write from the thread that ticks the site.
class SimulatedDevice final : public HapticDevice {
 public:
  /// Throws std::invalid_argument, naming the value, for settings out of range or no hand.
  SimulatedDevice(const SimulatedDeviceSettings& settings, std::unique_ptr<Hand> hand);

  /// Name "simulated", 3 degrees of freedom (with a guide too: the slot takes the rest), max_force.
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;

  /// Not valid if the state is no longer finite (a hand that broke its promise).
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f_W) noexcept override;

  /// True state of the handle, without encoder, at the last read.
  [[nodiscard]] const PointState& handle() const noexcept { return handle_; }

 private:
  [[nodiscard]] Vec3 toFree(const Vec3& a_W) const noexcept;
  [[nodiscard]] Vec3 toWorld(const Vec3& a_free) const noexcept;
  [[nodiscard]] PointState toWorld(const PointState& motion) const noexcept;
  [[nodiscard]] PointState encode(double interval) const noexcept;
  void advanceHandle(double interval) noexcept;

  SimulatedDeviceSettings settings_;
  std::unique_ptr<Hand> hand_;
  DeviceCapabilities capabilities_;
  PointState motion_;   ///< from the start, in the free axes: W's, or x alone along the guide
  PointState handle_;   ///< the same in W
  PointState counted_;  ///< what the encoder made of it at the last read, in the free axes
  Vec3 force_W_ = Vec3::Zero();
  double time_ = 0.0;
  bool was_read_ = false;
};

}  // namespace tandem
#pragma GCC visibility pop
