#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "tandem/bullet_bridge/haptic_body.h"
#include "tandem/bullet_bridge/host_world.h"
#include "tandem/bullet_bridge/obstacles.h"
#include "tandem/bullet_bridge/sphere_body.h"
#include "tandem/coordination/island.h"
#include "tandem/plugin/recording.h"
#include "tandem/plugin/site.h"

#include "force_guard.h"
#include "snapshots.h"
#include "state_hash.h"

namespace tandem {

/// A btRigidBody whose motion the island decides.
struct SiteBody {
  HapticBody* bullet = nullptr;
  BodyIndex index = 0;
  Vec3 f_gravity_W = Vec3::Zero();                        ///< weight, always on the island body
  Vec3 f_host_W = Vec3::Zero(), t_host_W = Vec3::Zero();  ///< host's own, on the island body now
  Vec3 owed_W = Vec3::Zero(),
       owed_angular_W = Vec3::Zero();           ///< host's impulses still to be given [N s]
  Vec3 f_W = Vec3::Zero(), t_W = Vec3::Zero();  ///< impulse mode: for the coming host step
};

struct SharedObject {
  std::unique_ptr<HapticBody> bullet;  ///< what `body` points to
  SiteBody body;
  ObjectId id = 0;
  double damping = 0.0;
  std::vector<CouplerIndex> couplers;  ///< one per remote: eqs (9), (10)
};

struct Remote {
  PeerId id{};
  Link* link = nullptr;
  RemoteUser user;
  std::unique_ptr<SphereBody> proxy;  ///< null where the scheme has none
  SiteBody body;                      ///< of the proxy
  StatePacket latest;
  bool heard = false;
  std::optional<Arrival> pending;  ///< fetched, not yet taken in
};

struct Site::Impl final : HostStepListener {
  Impl(const SiteSettings& settings, btDiscreteDynamicsWorld& host, HapticDevice& hand,
       BulletAbi abi);
  ~Impl() override;

  // Set-up: site.cpp
  ObjectId share(btRigidBody& body, double damping);
  void connect(PeerId peer, Link& link, const Vec3& start_W);
  void coordinate(SharedObject& object);
  void checkInjectionStable(const char* what, double stiffness, double damping, double mass) const;
  void finishSetUp();

  // The tick: site_tick.cpp
  std::uint32_t tick(double now) noexcept;
  void readDevice(double now) noexcept;
  void computeForce() noexcept;
  void advance(double now) noexcept;
  void advanceIsland(double until) noexcept;
  void takeInUntil(double time, double now) noexcept;
  [[nodiscard]] double nextArrival(double now, double until) noexcept;
  void takeIn(Remote& remote, const Arrival& arrival) noexcept;
  void sendIfDue(double until) noexcept;
  void send(double time) noexcept;
  void capture(double now) noexcept;
  void addToHash(double now) noexcept;

  // The host's step: site_host.cpp
  void beforeHostStep(double dt) noexcept override;
  void afterHostStep(double dt) noexcept override;
  bool allBodiesPresent() noexcept;
  void passHostChanges(double dt) noexcept;
  void settleHostForces() noexcept;
  void move(const SiteBody& body, const HostChange& change, double step_end) noexcept;
  void runTicksUntil(double time) noexcept;
  void handOff(double end, double dt) noexcept;
  [[nodiscard]] RigidState stateAt(BodyIndex body, double time) const noexcept;
  void updateObstacles(double dt);

  template <typename Visit>
  void forEachBody(Visit visit) {
    for (SharedObject& object : objects) visit(object.body);
    for (Remote& remote : remotes)
      if (remote.proxy) visit(remote.body);
  }

  [[nodiscard]] double period() const noexcept { return 1.0 / settings.haptic_rate; }
  [[nodiscard]] bool isHandoff() const noexcept {
    return settings.injection == Injection::kHandoff;
  }

  SiteSettings settings;
  const Scheme& scheme;
  HapticDevice& device;
  HostWorld host_world;
  Obstacles obstacles;
  Island island;
  BodyIndex hip = 0;
  std::vector<SharedObject> objects;
  std::vector<Remote> remotes;
  ForceGuard guard;
  StateHash hash;
  SiteCounters counters;
  Recording* recording = nullptr;

  std::uint32_t status_now = kTickOk, status_ever = kTickOk;
  std::uint64_t ticks = 0;
  std::uint64_t packets_due = 0;
  double start_time = 0.0;
  DeviceSample sample;
  Vec3 contact_W = Vec3::Zero();  ///< contact force on the device as the model has it [N]
  Vec3 force_W = Vec3::Zero();    ///< as rendered [N]

  double island_time = 0.0;
  double tick_start = 0.0;
  std::vector<RigidState> tick_start_states;
  double host_time = 0.0;           ///< host's simulated time
  double host_step = 0.0;           ///< its latest step; 0: not known
  double handoff_due = 0.0;         ///< next moment at which a host step ends
  double host_force_end = 0.0;      ///< without news from the host its forces end then
  double host_force_settled = 0.0;  ///< island time up to which they are booked
  Snapshots snapshots;
  std::vector<RigidState> scratch_states;
  std::vector<BodyRecord> object_records, proxy_records;
};

}  // namespace tandem
