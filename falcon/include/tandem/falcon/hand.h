#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/coordination/types.h"

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

}  // namespace tandem
#pragma GCC visibility pop
