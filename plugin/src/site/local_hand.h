#pragma once

#include <optional>

#include "tandem/falcon/haptic_device.h"
#include "tandem/plugin/site_settings.h"

#include "site/energy_port.h"
#include "site/force_guard.h"
#include "site/rest_mark.h"
#include "site/session_frame.h"

namespace tandem {

class Peers;

// clang-format off
/// The local user's hand: its device, its haptic interface point (HIP) in the island, its wrist, its
/// energy account and the rendered force and torque.
///
///     read -> place the HIP -> energy of the last tick -> contact force -> clamp -> slew -> energy
///     -> write
///
/// The energy limit comes last: it may take force away, and nothing after it gives any.
// clang-format on
class LocalHand {
 public:
  /// Adds the HIP to the island. Throws tandem::Error if the device gives no position.
  LocalHand(HapticDevice& device, const SiteSettings& settings, Island& island, bool island_moves);

  [[nodiscard]] BodyIndex hip() const noexcept { return hip_; }
  /// The latest sample as the device gave it.
  [[nodiscard]] const DeviceSample& sample() const noexcept { return sample_; }
  /// True if the latest sample has a usable position.
  [[nodiscard]] bool isThere() const noexcept { return is_there_; }

  void read(double now) noexcept;
  /// The latest usable orientation; empty: the device has none.
  [[nodiscard]] const std::optional<WristState>& wrist() const noexcept { return wrist_; }
  /// The host's world got another origin; the hand goes along.
  void shiftOrigin(const Vec3& offset_W) noexcept;
  /// Moves the HIP to the hand. Without a usable sample the HIP stays and its velocity is zero.
  void place() noexcept;
  /// Gives the HIP a steady velocity to the hand's position, reached after `duration` [s]. For
  /// ticks that were left out.
  void lead(double duration) noexcept;
  /// Adds the work of the last tick's force to the energy account.
  void countWork() noexcept;

  /// Contact force on the HIP in the island [N], cached while the island sleeps.
  [[nodiscard]] const Vec3& computeContactForce() noexcept;
  /// True if the device renders torques.
  [[nodiscard]] bool feelsTorque() const noexcept { return most_torque_ > 0.0; }
  /// Computes force and torque of this tick, within the energy that is left. With a `fault` they
  /// fade.
  void render(const Vec3& contact_W, const Vec3& torque_W, const Peers& peers, bool fault) noexcept;
  void write() noexcept;
  /// Writes zero force at once, without a slew.
  void letGo() noexcept;
  /// True: the force fades to zero and stays there. False: it may rise again.
  void setFading(bool fades) noexcept { fades_ = fades; }

  /// Contact force of the model and the rendered force, in W [N].
  [[nodiscard]] const Vec3& contact() const noexcept { return contact_W_; }
  [[nodiscard]] const Vec3& force() const noexcept { return force_W_; }
  /// Rendered torque, in W [N m]; 0 if the device renders none.
  [[nodiscard]] const Vec3& torque() const noexcept { return torque_W_; }
  /// The HIP at `time` [s], for a packet. Inside a tick a continuous device is read again.
  [[nodiscard]] PointState pointAt(double time, double tick_start) noexcept;

  [[nodiscard]] EnergyPort& energy() noexcept { return energy_; }
  [[nodiscard]] const EnergyPort& energy() const noexcept { return energy_; }
  [[nodiscard]] const ForceGuard& guard() const noexcept { return guard_; }

  /// Drops the cached contact force, after set-up.
  void forgetRest() noexcept { contact_rest_.clear(); }

 private:
  HapticDevice& device_;
  Island& island_;
  double period_;
  BodyIndex hip_ = 0;
  double most_torque_;  ///< [N m]
  ForceGuard guard_, torque_guard_;
  EnergyPort energy_;
  SessionFrame frame_;  ///< of the device
  DeviceSample sample_;
  PointState hand_;  ///< of the latest sample, in W
  std::optional<WristState> wrist_;
  bool is_there_ = false, was_there_ = true;
  Vec3 v_known_W_ = Vec3::Zero();   ///< of the latest usable sample
  Vec3 v_before_W_ = Vec3::Zero();  ///< of the usable sample before it
  std::optional<Vec3> p_before_W_;  ///< the hand one tick ago, if known
  double read_at_ = 0.0;            ///< time of the latest usable sample [s]
  double elapsed_ = 0.0;            ///< from the one before it [s]
  Vec3 contact_W_ = Vec3::Zero(), force_W_ = Vec3::Zero(), torque_W_ = Vec3::Zero();
  RestMark contact_rest_;  ///< when the contact force was computed
  bool fades_ = false;
};

}  // namespace tandem
