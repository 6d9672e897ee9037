#pragma once

#include <memory>

#include "tandem/falcon/haptic_device.h"
#include "tandem/falcon/pointer_plane.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A handle, the hand that pulls it after a cursor, and the cursor's glide.
struct MouseSettings {
  double mass = 0.1;              ///< m of the handle [kg], > 0; higher follows more slowly
  double stiffness = 300.0;       ///< K of the hand [N/m], > 0; higher stretches less under a force
  double damping = 8.0;           ///< B of the hand [N s/m], >= 0; higher swings less
  double handle_damping = 2.0;    ///< b, the handle's own friction [N s/m], >= 0; higher lags more
  double hand_force = 8.0;        ///< F_hand, the most that the hand pulls with [N], > 0
  double max_force = 10.0;        ///< limit of the rendered force, direction kept [N], >= 0
  double shortest_glide = 0.016;  ///< [s], > 0; longer is smoother and later
  double longest_glide = 0.050;   ///< [s], not below shortest_glide; bridges slower events
  Vec3 start_W = Vec3::Zero();    ///< handle, cursor and target at the start [m]
  double workspace = 0.4;         ///< radius about the start in which targets may be [m], > 0
};

/// The parts of a mouse that a picture shows.
struct MouseView {
  Vec3 handle_W = Vec3::Zero();  ///< x, the haptic interface point [m]
  Vec3 cursor_W = Vec3::Zero();  ///< c, which the hand pulls the handle to [m]
  Vec3 force_W = Vec3::Zero();   ///< f_site of the last write, within max_force [N]
  bool is_slack = false;         ///< the hand is at its limit: more way gives no more force
};

/// A pointer as a haptic device: a mouse, a stick, or anything else that gives a target in W at
/// irregular times. A simulated hand pulls a simulated handle after a cursor c:
///
///   m x'' = f_hand + f_site - b x'      f_hand = limited(K (c - x) + B (c' - x'), F_hand)
///
/// The user sees a force as the stretch |x - c|, at rest 3.3 mm per newton by default. At its limit
/// the hand presses with F_hand, however far the pointer goes.
///
/// The cursor glides to each new target in a straight line, from where it is. The glide takes
/// T = clamp(1.25 (t_i - t_i-1), 16 ms, 50 ms), with t_i the times of the targets, and 50 ms for
/// the first. Meanwhile c' is way / T, afterwards 0.
///
/// Two threads use it without a lock, one for the window and one for the site. The clock of
/// moveTo() need not be that of read(): only its intervals count. At most 50 ms pass for the handle
/// in one read, and none in the first one: it goes on from where it was after a pause, and when a
/// site with a clock of its own takes over. Equal calls in equal order give equal bits.
class MouseDevice final : public HapticDevice {
 public:
  /// Throws std::invalid_argument with the setting's name if one is out of range, also if the hand
  /// is too stiff for the mass to be stable at steps of 0.25 ms.
  explicit MouseDevice(const MouseSettings& settings = {});
  ~MouseDevice() override;

  // For the window's thread. Wait-free, without allocation.

  /// Moves the target at `time` [s] of the window's clock. False, and nothing changes, for a target
  /// out of reach or not finite, a time that runs back or is not finite, and while held.
  bool moveTo(const Vec3& target_W, double time) noexcept;

  /// Keeps the target where it is until release(): for a pointer that leaves the window.
  void hold() noexcept { is_held_ = true; }
  /// Lets moveTo() move the target again; the cursor then glides to wherever the pointer is.
  void release() noexcept { is_held_ = false; }
  [[nodiscard]] bool isHeld() const noexcept { return is_held_; }

  /// The last target that moveTo() took; the start before.
  [[nodiscard]] const Vec3& target() const noexcept { return target_W_; }
  [[nodiscard]] const PointerReach& reach() const noexcept { return reach_; }

  /// As of the last read or write.
  [[nodiscard]] MouseView view() noexcept;

  // For the thread that ticks the site. Wait-free, without allocation.

  /// Name "mouse", 3 degrees of freedom, max_force and the workspace; not continuous.
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;

  /// Moves the handle on to `now` [s] under the force of the last write. A `now` that is not later
  /// than the last one, or not finite, moves nothing. The site may push the handle out of the
  /// workspace, which limits targets only. Valid from the first read on.
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f_W) noexcept override;

 private:
  struct Exchange;
  class Handle;

  DeviceCapabilities capabilities_;
  PointerReach reach_;
  double shortest_glide_, longest_glide_;  ///< [s]

  Vec3 target_W_;
  double time_ = 0.0;  ///< of the last target, on the window's clock [s]
  bool was_moved_ = false, is_held_ = false;

  std::unique_ptr<Exchange> exchange_;  ///< outlives the handle
  std::unique_ptr<Handle> handle_;
};

}  // namespace tandem
#pragma GCC visibility pop
