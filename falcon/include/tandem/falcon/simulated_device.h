#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tandem/falcon/haptic_device.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Model of a simulated user's hand on the device's handle.
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

/// One target of a hand's path: at `p_W` at time `t` [s].
struct Waypoint {
  double t = 0.0;
  Vec3 p_W = Vec3::Zero();
};

/// A hand that moves between waypoints by minimum-jerk strokes (Flash & Hogan 1985). It holds the
/// handle by a spring-damper: f = K (p_ref - p) + B (v_ref - v). It rests before the first and
/// after the last waypoint. For a stroke of length d and duration T, with u in 0..1:
///
///   p_ref = p_0 + d (10 u^3 - 15 u^4 + 6 u^5)      v_ref = d/T 30 u^2 (1 - u)^2
///
/// Throws std::invalid_argument with the value's name: no waypoint, times that do not grow,
/// negative gains, or non-finite values.
[[nodiscard]] std::unique_ptr<Hand> makeMinimumJerkHand(std::vector<Waypoint> waypoints,
                                                        double stiffness, double damping);

/// Plays back a recorded force: linear between rows, constant before the first and after the last.
/// The file's first line is the header `t,force_x,force_y,force_z`; lines end in LF or CRLF. This
/// function reads the whole file; the hand does no I/O. Throws tandem::Error with file, line and
/// cause: missing file or column, a device or a pipe, bad number, times that do not grow,
/// non-finite value, a component above 1e6 N.
[[nodiscard]] std::unique_ptr<Hand> makeRecordedHand(const std::string& csv_path);

/// A damped mass in a simulated hand, sampled at the haptic rate.
struct SimulatedDeviceSettings {
  double mass = 0.1;                ///< m_h of the handle [kg], > 0; higher moves more slowly
  double damping = 0.5;             ///< b_dev, the device's own friction [N s/m], >= 0
  Vec3 start_W = Vec3::Zero();      ///< rest position of the handle at t = 0 [m]
  std::optional<Vec3> guide;        ///< unit vector of a slot that limits the handle to this line
  double encoder_resolution = 0.0;  ///< step of the position reading [m]; 0: exact
  /// Saturation of the motors, direction kept [N], >= 0; may be infinite. The paper's rows need at
  /// most 48 N, within a minute.
  double max_force = 60.0;
};

/// Device of eqs (1), (2): m_h x'' + b_dev x' = F_hand + f_W, where f_W is the force of the last
/// write. Source: Li & Constantinescu 2009.
///
/// read(now) advances the handle from the last read to `now` and holds f_W constant, as a real
/// device does. A constant hand gives a solution exact to rounding, for any damping and grouping of
/// reads. Other hands give second order in the sub-step (0.25 ms at 1 kHz). They are stable for
/// stiffness below 4 m / sub-step^2. An earlier or non-finite `now` moves nothing.
///
/// A guide is a frictionless bilateral slot. The motion along it is one scalar, so the handle
/// cannot leave the line. An encoder counts displacement from the start along each free axis: W's
/// three, or the guide. The velocity is then the first difference of the counted positions. The
/// same calls give the same bits. Not thread safe: read and write from the thread that ticks the
/// site.
class SimulatedDevice final : public HapticDevice {
 public:
  /// Throws std::invalid_argument if a setting is out of range (with its name) or there is no hand.
  SimulatedDevice(const SimulatedDeviceSettings& settings, std::unique_ptr<Hand> hand);

  /// Name "simulated", 3 degrees of freedom (also with a guide) and max_force.
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;

  /// Not valid if the state is not finite, which only a faulty Hand causes.
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f_W) noexcept override;

  /// True state of the handle at the last read, without the encoder.
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
  PointState motion_;   ///< displacement in the free axes: W's, or x alone along the guide
  PointState handle_;   ///< state of the handle in W
  PointState counted_;  ///< encoder's reading at the last read, in the free axes
  Vec3 force_W_ = Vec3::Zero();
  double time_ = 0.0;
  bool was_read_ = false;
};

}  // namespace tandem
#pragma GCC visibility pop
