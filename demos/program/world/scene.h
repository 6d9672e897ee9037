#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

#include "scenario/scenario.h"

namespace tandem::demos {

/// The scene's own frame S of scenarios and results: x along the axis from user 1 to user 2, z up,
/// origin at the shared object's start. W is Bullet's world.
struct SceneFrame {
  Quat q_WS = Quat::Identity();
  [[nodiscard]] Vec3 toWorld(const Vec3& v_S) const { return q_WS * v_S; }
  [[nodiscard]] Vec3 toScene(const Vec3& v_W) const { return q_WS.conjugate() * v_W; }
};

[[nodiscard]] SceneFrame makeSceneFrame(const Scenario& scenario);

/// Start of a user's device in W: just in contact, on the axis, plus the scenario's offset.
[[nodiscard]] Vec3 computeStart(const Scenario& scenario, const SceneFrame& frame, int site);

/// A body of one site's world, for pictures.
struct SceneBody {
  std::string name;
  std::string role;                   ///< object, proxy, device, neighbour or obstacle
  const btRigidBody* body = nullptr;  ///< null: the device, which has no body in Bullet
  bool is_box = false;
  Vec3 half_extents = Vec3::Zero();
  double radius = 0.0;
  bool is_static = false;
};

/// Bodies that begin elsewhere than the scenario says, by name.
using BodyPlaces = std::map<std::string, RigidState>;

/// One site's Bullet world with its bodies, device and site, as a host would have them.
class SiteWorld {
 public:
  /// `index` is 0 for site 1, 1 for site 2. `link` leads to the other site. The device is
  /// simulated.
  SiteWorld(const Scenario& scenario, int index, Link& link, const BodyPlaces& places = {});
  /// The same with any device, for instance a replayed one, which must outlive this.
  SiteWorld(const Scenario& scenario, int index, Link& link, HapticDevice& device,
            const BodyPlaces& places = {});
  ~SiteWorld();
  SiteWorld(const SiteWorld&) = delete;
  SiteWorld& operator=(const SiteWorld&) = delete;

  [[nodiscard]] Site& site() noexcept { return *site_; }
  [[nodiscard]] btDiscreteDynamicsWorld& world() noexcept { return world_; }
  /// Valid only if the device is simulated.
  [[nodiscard]] SimulatedDevice& device() noexcept { return *simulated_; }
  [[nodiscard]] const std::vector<SceneBody>& bodies() const noexcept { return scene_bodies_; }
  /// Where all bodies are now that may move, for another world of the same scenario.
  [[nodiscard]] BodyPlaces places() const;
  /// Pose of a scene body now, in W.
  [[nodiscard]] RigidState pose(const SceneBody& body) const;

  /// Runs the host steps that end by `now` [s]. All ticks that start inside them must be done. The
  /// hand holds the object in the times of the scenario.
  void stepHostUntil(double now);
  /// The user wants to hold the object, or not: the hand takes hold once it touches it.
  void hold(bool wants);

 private:
  [[nodiscard]] bool isGripTime(double time) const noexcept;
  void build(const Scenario& scenario, int index, Link& link, HapticDevice& device);
  btRigidBody& addBox(const Vec3& half_extents, double mass, const Vec3& p_S,
                      const std::string& name, const std::string& role);
  void addObstacles(const Scenario& scenario);

  SceneFrame frame_;
  BodyPlaces places_;
  double friction_;
  double host_rate_;
  double hand_radius_ = 0.0;                  ///< [m]
  double object_size_ = 0.0;                  ///< 0: no object that can be held
  std::vector<std::array<double, 2>> grips_;  ///< from, to [s]
  bool holds_ = false;
  std::uint64_t host_steps_ = 0;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<SceneBody> scene_bodies_;
  std::unique_ptr<SimulatedDevice> simulated_;  ///< null with another device
  std::unique_ptr<Site> site_;
};

}  // namespace tandem::demos
