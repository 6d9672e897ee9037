#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "relay/relayed_sites.h"
#include "support/metered_device.h"

namespace tandem::test {

/// Largest values of a site's force since the last time they were asked for.
struct ForceReport {
  double force = 0.0;  ///< [N]
  double rise = 0.0;   ///< from tick to tick [N]
  bool is_finite = true;
};

/// Two users with worlds who move one cube, at sites with a relay and a direct way, in virtual
/// time. User 1 pushes and goes back once in two seconds; user 2 holds against it with 60 N/m.
class HandsByRelay {
 public:
  static constexpr double kReach = 0.06;               ///< of a stroke [m]
  static constexpr double kArm = 150.0;                ///< user 1's stiffness [N/m]
  static constexpr double kWallForce = kArm * kReach;  ///< at a wall where a stroke begins [N]

  explicit HandsByRelay(const RelayedSites::Ways& ways) : sites(2, ways) {
    for (int id : {1, 2}) makeUser(id);
    sites.act_instead = [this](int id) { tick(id); };
  }
  ~HandsByRelay() {
    for (User& user : users_) user.site.reset();  // before its world, device and link
  }
  HandsByRelay(const HandsByRelay&) = delete;
  HandsByRelay& operator=(const HandsByRelay&) = delete;

  /// Of both sites together.
  [[nodiscard]] ForceReport take() {
    ForceReport all;
    for (User& user : users_) {
      all.force = std::max(all.force, user.report.force);
      all.rise = std::max(all.rise, user.report.rise);
      all.is_finite &= user.report.is_finite;
      user.report = {};
    }
    return all;
  }
  [[nodiscard]] LinkState link(int id) const { return user(id).site->linkState(0); }
  /// Distance of the two copies of the cube [m].
  [[nodiscard]] double apart() const {
    return (user(1).site->object(0).p_W - user(2).site->object(0).p_W).norm();
  }
  /// Energy that both hands have put in [J].
  [[nodiscard]] double putIn() const { return user(1).device->putIn() + user(2).device->putIn(); }

  RelayedSites sites;

 private:
  static constexpr double kHalf = 0.02, kRadius = 0.01;  // [m]
  static constexpr double kWait = 4.0;                   ///< before the first stroke [s]
  static constexpr int kTicksPerHostStep = 4;

  struct User {
    BulletRig rig;
    std::unique_ptr<SimulatedDevice> handle;
    std::unique_ptr<MeteredDevice> device;
    std::unique_ptr<Site> site;
    std::uint64_t ticks = 0;
    double last_force = 0.0;
    ForceReport report;
  };

  /// To and fro, held by an arm of 150 N/m and 3 N s/m. It waits until the other has met it: a
  /// stand-in comes in only where there is room.
  class PushingHand final : public Hand {
   public:
    [[nodiscard]] Vec3 computeForce(double t, const PointState& handle) const noexcept override {
      const double turn = std::numbers::pi * std::max(t - kWait, 0.0);
      const double x = startOf(1).x() + 0.5 * kReach * (1.0 - std::cos(turn));
      const double v = 0.5 * kReach * std::numbers::pi * std::sin(turn);
      return {kArm * (x - handle.p_W.x()) + 3.0 * (v - handle.v_W.x()), 0.0, 0.0};
    }
  };

  static Vec3 startOf(int id) { return {(id == 1 ? -1.0 : 1.0) * (kHalf + kRadius), 0.0, 0.0}; }

  [[nodiscard]] User& user(int id) { return users_[static_cast<std::size_t>(id) - 1]; }
  [[nodiscard]] const User& user(int id) const { return users_[static_cast<std::size_t>(id) - 1]; }

  void makeUser(int id) {
    User& own = user(id);
    SimulatedDeviceSettings device;
    device.start_W = startOf(id);
    device.guide = Vec3::UnitX();
    std::unique_ptr<Hand> hand = std::make_unique<PushingHand>();
    if (id == 2) hand = makeMinimumJerkHand({{0.0, startOf(2)}}, 60.0, 1.0);
    own.handle = std::make_unique<SimulatedDevice>(device, std::move(hand));
    own.device = std::make_unique<MeteredDevice>(*own.handle);
    SiteSettings settings;
    settings.self = PeerId{static_cast<std::uint32_t>(id)};
    settings.tick_source = TickSource::kCaller;
    settings.host_step = 1e-3 * kTicksPerHostStep;
    settings.link_loss.start_live = false;
    settings.guide = Vec3::UnitX();
    own.site = std::make_unique<Site>(settings, own.rig.world, *own.device);
    own.site->share(own.rig.addCube(0.2, kHalf), 4.0);
    const PeerId other{static_cast<std::uint32_t>(3 - id)};
    own.site->connect(other, sites.at(id).mesh->link(other), startOf(3 - id));
  }

  void tick(int id) {
    User& own = user(id);
    own.site->tick(sites.now());
    const double force = own.site->force().norm();
    own.report.force = std::max(own.report.force, force);
    own.report.rise = std::max(own.report.rise, std::abs(force - own.last_force));
    own.report.is_finite &= std::isfinite(force) && isFinite(own.site->object(0));
    own.last_force = force;
    if (++own.ticks % kTicksPerHostStep == 0) own.rig.step(1e-3 * kTicksPerHostStep);
  }

  std::array<User, 2> users_;
};

}  // namespace tandem::test
