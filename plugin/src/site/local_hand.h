#pragma once

#include <optional>

#include "tandem/falcon/haptic_device.h"
#include "tandem/plugin/site_settings.h"

#include "site/energy_port.h"
#include "site/force_guard.h"
#include "site/rest_mark.h"

namespace tandem {

/// The local user's hand: its device, the haptic interface point in the island, the energy that it
/// may get, and the force that is rendered.
///
///     read -> place (HIP) -> energy of the last tick -> force: contact -> clamp -> energy -> slew
///     -> write
class LocalHand {
 public:
  /// Puts the HIP into the island. Throws tandem::Error if the device gives no position.
  LocalHand(HapticDevice& device, const SiteSettings& settings, Island& island, bool island_moves);

  [[nodiscard]] BodyIndex hip() const noexcept { return hip_; }
  [[nodiscard]] const DeviceSample& sample() const noexcept { return sample_; }
  /// True if the latest sample says where the hand is.
  [[nodiscard]] bool isThere() const noexcept { return sample_.valid && isFinite(sample_.hip); }

  void read(double now) noexcept { sample_ = device_.read(now); }
  /// The HIP is where the hand is. If nobody knows that, it stays and pushes no further.
  void place() noexcept;
  /// The HIP goes steadily to where the hand is, for as long as ticks were left out [s].
  void lead(double duration) noexcept;
  /// The work of the force of the last tick.
  void countWork() noexcept;

  /// Contact force on the HIP in the island [N]; computed anew when something has moved.
  [[nodiscard]] const Vec3& computeContactForce() noexcept;
  /// The force of this tick. `shares_energy`: all peers keep accounts. With a `fault` it fades.
  void render(const Vec3& contact_W, bool shares_energy, bool fault) noexcept;
  void write() noexcept { device_.write(force_W_); }
  /// No force, at once and without a slew.
  void letGo() noexcept { device_.write(Vec3::Zero()); }
  /// From now on the force fades to zero and stays there, or it may rise again.
  void setFading(bool fades) noexcept { fades_ = fades; }

  /// Contact force on the device as the model has it, and the force as rendered, in W [N].
  [[nodiscard]] const Vec3& contact() const noexcept { return contact_W_; }
  [[nodiscard]] const Vec3& force() const noexcept { return force_W_; }
  /// The HIP at `time` [s], for a packet. Inside a tick a continuous device is asked again.
  [[nodiscard]] PointState pointAt(double time, double tick_start) noexcept;

  [[nodiscard]] EnergyPort& energy() noexcept { return energy_; }
  [[nodiscard]] const EnergyPort& energy() const noexcept { return energy_; }
  [[nodiscard]] const ForceGuard& guard() const noexcept { return guard_; }

  /// After set-up all that was computed is news.
  void forgetRest() noexcept { contact_rest_.clear(); }

 private:
  HapticDevice& device_;
  Island& island_;
  double period_;
  BodyIndex hip_ = 0;
  ForceGuard guard_;
  EnergyPort energy_;
  DeviceSample sample_;
  std::optional<Vec3> p_before_W_;  ///< where the hand was a tick ago, if that is known
  Vec3 contact_W_ = Vec3::Zero(), force_W_ = Vec3::Zero();
  RestMark contact_rest_;  ///< the contact force was computed
  bool fades_ = false;
};

}  // namespace tandem
