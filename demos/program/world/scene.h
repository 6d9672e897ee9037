#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

#include "scenario/scenario.h"
#include "world/scene_world.h"

namespace tandem::demos {

/// The links of a site to all other sites, in the order of their numbers.
class PeerLinks {
 public:
  // NOLINTNEXTLINE(google-explicit-constructor): a site of two has one link
  PeerLinks(Link& only) : links_{&only} {}
  explicit PeerLinks(std::vector<Link*> links) : links_(std::move(links)) {}
  /// The link of the site `own` to another one; both count from 0.
  [[nodiscard]] Link& to(int other, int own) const {
    return *links_.at(static_cast<std::size_t>(other < own ? other : other - 1));
  }

 private:
  std::vector<Link*> links_;
};

/// One site's Bullet world with its bodies, device and site, as a host would have them.
class SiteWorld {
 public:
  /// `index` is 0 for site 1, 1 for site 2, and so on. Links must outlive this. The device is
  /// simulated.
  SiteWorld(const Scenario& scenario, int index, const PeerLinks& links,
            const BodyPlaces& places = {});
  /// The same with any device, for instance a replayed one, which must outlive this.
  SiteWorld(const Scenario& scenario, int index, const PeerLinks& links, HapticDevice& device,
            const BodyPlaces& places = {});
  ~SiteWorld();
  SiteWorld(const SiteWorld&) = delete;
  SiteWorld& operator=(const SiteWorld&) = delete;

  [[nodiscard]] Site& site() noexcept { return *site_; }
  [[nodiscard]] btDiscreteDynamicsWorld& world() noexcept { return scene_.world(); }
  /// Valid only if the device is simulated.
  [[nodiscard]] SimulatedDevice& device() noexcept { return *simulated_; }
  [[nodiscard]] const std::vector<SceneBody>& bodies() const noexcept { return scene_bodies_; }
  /// The places of all bodies that may move, for another world of the same scenario.
  [[nodiscard]] BodyPlaces places() const;
  /// Pose of a scene body now, in W.
  [[nodiscard]] RigidState pose(const SceneBody& body) const;

  /// Runs the host steps that end by `now` [s]. All ticks that start inside them must be done. The
  /// hand holds the object in the times of the scenario.
  void stepHostUntil(double now);
  /// The user wants to hold the object, or not: the hand takes hold once it touches it. From the
  /// first call on the times of the scenario do not count.
  void hold(bool wants);

 private:
  [[nodiscard]] bool isGripTime(double time) const noexcept;
  void holdOrRelease(bool wants);
  void build(const Scenario& scenario, int index, const PeerLinks& links, HapticDevice& device);
  void connect(const Scenario& scenario, int index, const PeerLinks& links);
  void share(const PlacedBody& placed);
  [[nodiscard]] std::optional<ObjectId> findInReach() const;

  SceneWorld scene_;
  double host_rate_;
  double hand_radius_ = 0.0;  ///< [m]
  bool may_grip_ = false;
  std::vector<ObjectId> grippable_;           ///< what no user has as a tool
  std::vector<std::array<double, 2>> grips_;  ///< from, to [s]
  bool holds_ = false;
  std::uint64_t host_steps_ = 0;
  std::vector<SceneBody> scene_bodies_;
  std::unique_ptr<SimulatedDevice> simulated_;  ///< null with another device
  std::unique_ptr<Site> site_;
};

}  // namespace tandem::demos
