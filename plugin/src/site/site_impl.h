#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tandem/coordination/island_counters.h"
#include "tandem/coordination/link.h"
#include "tandem/coordination/passivity_observer.h"
#include "tandem/coordination/scheme.h"
#include "tandem/falcon/haptic_device.h"
#include "tandem/plugin/recording.h"
#include "tandem/plugin/site.h"

#include "bullet_bridge/src/bodies/driven_body.h"
#include "bullet_bridge/src/bodies/haptic_body.h"
#include "bullet_bridge/src/bodies/sphere_body.h"
#include "bullet_bridge/src/surroundings/neighbours.h"
#include "bullet_bridge/src/surroundings/obstacles.h"
#include "bullet_bridge/src/surroundings/standing_watch.h"
#include "bullet_bridge/src/world/host_world.h"
#include "coordination/src/island/island.h"
#include "coordination/src/link/link_health.h"
#include "coordination/src/schemes/remote_user.h"
#include "live/island_desk.h"
#include "site/detour.h"
#include "site/force_guard.h"
#include "site/native_model.h"
#include "site/packet_turns.h"
#include "site/rest_mark.h"
#include "site/snapshots.h"
#include "site/state_hash.h"
#include "site/user_track.h"

namespace tandem {

/// Momentum given to an island body at a time that the host has not come to yet.
struct GivenImpulse {
  double time = 0.0;  ///< of the island [s]
  Vec3 impulse_W = Vec3::Zero(), angular_impulse_W = Vec3::Zero();
};

/// A btRigidBody whose motion the island decides.
struct SiteBody {
  HapticBody* bullet = nullptr;  ///< null also from the end of the host's world on
  BodyIndex index = 0;
  Vec3 f_gravity_W = Vec3::Zero();                        ///< weight, always on the island body
  Vec3 f_host_W = Vec3::Zero(), t_host_W = Vec3::Zero();  ///< host's own, on the island body now
  Vec3 owed_W = Vec3::Zero(),
       owed_angular_W = Vec3::Zero();           ///< host's impulses still to be given [N s]
  Vec3 f_W = Vec3::Zero(), t_W = Vec3::Zero();  ///< impulse mode: for the coming host step
  // Of the present host step: what the host's thread saw, and what the island said.
  HostChange change;  ///< by the host, if it `is_told`
  bool is_told = false;
  Vec3 f_gravity_seen_W = Vec3::Zero();
  RigidState end;                                           ///< at the end of the step
  Vec3 hit_W = Vec3::Zero(), angular_hit_W = Vec3::Zero();  ///< impulses of Bullet's solver
  bool stands = false;
  bool was_parked = false;
  bool may_park = false;            ///< the host's forces are settled
  RigidState seen;                  ///< as Bullet has it, for who may not look himself
  bool was_near_awake = false;      ///< parked, but Bullet woke it: something awake is near
  int steps_stood = 0;              ///< host steps in which nothing moved or hit it
  std::vector<GivenImpulse> given;  ///< what Bullet's state does not have yet; room is reserved

  /// Without room the latest two count as one.
  void note(const GivenImpulse& impulse) noexcept {
    if (given.size() < given.capacity()) {
      given.push_back(impulse);
    } else if (!given.empty()) {
      given.back().time = impulse.time;
      given.back().impulse_W += impulse.impulse_W;
      given.back().angular_impulse_W += impulse.angular_impulse_W;
    }
  }
};

/// Status bits that stay.
inline constexpr std::uint32_t kForGood = kBodyMissing | kStateNotFinite | kWorldGone;

/// Of impulses that a late host does not have yet.
inline constexpr std::size_t kGivenImpulses = 64;

struct SharedObject {
  btRigidBody* rigid = nullptr;        ///< the host's
  std::unique_ptr<HapticBody> bullet;  ///< what `body` points to
  SiteBody body;
  ObjectId id = 0;
  double damping = 0.0;
  double bounding_radius = 0.0;
  std::vector<CouplerIndex> couplers;  ///< one per remote: eqs (9), (10)
  std::vector<RigidState> theirs;      ///< per remote: its copy as heard last
  std::vector<Detour> detours;         ///< per remote: what its coupler pulls to besides
  RigidState sent;                     ///< as in the latest packet that had it
};

/// A moving body of the host that the island holds while it may take part in contact: dynamic, then
/// the island moves it, or kinematic, then the host does.
struct Neighbour {
  btRigidBody* rigid = nullptr;                        ///< null: the slot is empty
  const btCollisionShape* shape = nullptr;             ///< that it came with
  IslandBody settings;                                 ///< of the slot
  std::unique_ptr<HapticBody> bullet;                  ///< of a dynamic one: what `body` points to
  std::unique_ptr<DrivenBody> driven;                  ///< of a kinematic one
  double linear_damping = 0.0, angular_damping = 0.0;  ///< as Bullet understands it, seen last
  SiteBody body;
  GivenImpulse owed;     ///< by which it goes back
  bool is_new = false;   ///< promoted, but not in the island yet
  bool is_held = false;  ///< dynamic, and the island has it

  [[nodiscard]] bool isInWorld() const noexcept {
    return bullet ? bullet->isInWorld() : driven->isInWorld();
  }
};

struct Remote {
  PeerId id{};
  Link* link = nullptr;
  RemoteUser user;
  std::unique_ptr<SphereBody> proxy;      ///< null where the scheme has none
  KinematicSphere* held_proxy = nullptr;  ///< in its place in a native model, if it is held
  SiteBody body;                          ///< of the proxy
  StatePacket latest;
  bool heard = false;
  std::optional<double> reported;  ///< energy that it has put in, as heard last [J]
  LinkHealth health{LinkLossSettings{}, 1.0};
  UserTrack track;                          ///< of the user, as the scheme is told
  LinkState link_state = LinkState::kLive;  ///< as it was acted on last
  bool is_detouring = false;                ///< some object's target is not where its copy is
  bool is_restrained = false;               ///< something is not as with a live peer
  double velocity_share = 1.0;              ///< by which targets have been slowed down
  std::uint64_t rejoined_by = 0;            ///< packet with which it came back
  Vec3 searched_W = Vec3::Zero();           ///< around here what is near the proxy is known
  /// Per object: which packet its target is from.
  std::vector<std::optional<std::uint64_t>> object_sequences;
  std::optional<Arrival> pending;  ///< fetched, not yet taken in
  bool ghost_seen = false;         ///< its proxy is one in the island, as the host's thread knows
  bool ghost_shown = false;        ///< and in the host's world
};

struct Site::Impl final : HostStepListener {
  Impl(const SiteSettings& settings, btDiscreteDynamicsWorld& host, HapticDevice& hand,
       BulletAbi abi);
  ~Impl() override;

  // Set-up: site_set_up.cpp
  void checkOpenToSetUp();
  ObjectId share(btRigidBody& body, double damping);
  void connect(PeerId peer, Link& link, const Vec3& start_W);
  void coordinate(SharedObject& object);
  void checkInjectionStable(const char* what, double stiffness, double damping, double mass) const;
  void finishSetUp();

  // The tick: site_tick.cpp
  std::uint32_t tick(double now) noexcept;
  void beginLive();
  void makeUp(double now) noexcept;
  void loseTime(double until) noexcept;
  void placeHand() noexcept;
  void endHostForces() noexcept;
  void computeForce() noexcept;
  void advance(double now, double end) noexcept;
  void advanceIsland(double until) noexcept;
  void takeInUntil(double time, double now) noexcept;
  [[nodiscard]] double nextArrival(double now, double until) noexcept;
  void takeIn(Remote& remote, const Arrival& arrival, double time) noexcept;
  bool takeInObjects(Remote& remote, const StatePacket& packet) noexcept;
  void keepStates(double time) noexcept;
  [[nodiscard]] bool isStill() const noexcept;
  void lookForIdleness(double now) noexcept;
  void sendIfDue(double until) noexcept;
  void send(double time) noexcept;
  void capture(double now) noexcept;
  void addToHash(double now) noexcept;

  // The host's step: site_host.cpp
  void beforeHostStep(double dt) noexcept override;
  void afterHostStep(double dt) noexcept override;
  bool allBodiesPresent() noexcept;
  void passHostChanges(double dt) noexcept;
  void give(SiteBody& body, const Vec3& impulse_W, const Vec3& angular_impulse_W) noexcept;
  void followHostClock(double dt) noexcept;
  void followLiveHost(double late, double dt) noexcept;
  void settleHostForces() noexcept;
  void lookAtBodies(double dt) noexcept;
  void takeBack(SiteBody& body) noexcept;
  void receive(SiteBody& body) noexcept;
  void announceNextEnd(double dt) noexcept;
  void move(const SiteBody& body, const HostChange& change) noexcept;
  void runTicksUntil(double time) noexcept;
  void findEnds(double end) noexcept;
  void handOff(double dt) noexcept;
  [[nodiscard]] RigidState stateAt(BodyIndex body, double time) noexcept;

  // What a silent peer still does: site_links.cpp
  void hearRemote(Remote& remote, const StatePacket& packet, double time) noexcept;
  void followLinks(double now) noexcept;
  void followLink(Remote& remote, double now) noexcept;
  void countLinks() noexcept;
  [[nodiscard]] btRigidBody* findProxyBody(const Remote& remote) const noexcept;
  [[nodiscard]] bool isPlaceFree(const Remote& remote) const noexcept;
  [[nodiscard]] bool isRenewed(const Remote& remote, const SharedObject& object) const noexcept;
  [[nodiscard]] bool doCopiesAgree(const Remote& remote) const noexcept;
  void carryGhost(const Remote& remote, double now) noexcept;
  void slowTargets(Remote& remote) noexcept;
  void followDetours(Remote& remote) noexcept;
  void restrainObjects(const Remote& remote) noexcept;
  void showGhost(Remote& remote) noexcept;
  void restrainProxy(Remote& remote) noexcept;
  void noteSearched() noexcept;

  // Account of energy: site_energy.cpp
  [[nodiscard]] bool keepsAccount() const noexcept;
  void countHandWork() noexcept;
  void setWorldWrench(BodyIndex body, const Vec3& f_W, const Vec3& t_W) noexcept;
  void countWorldWork() noexcept;
  void countImpulse(const SiteBody& body, const RigidState& before, const Vec3& impulse_W,
                    const Vec3& angular_impulse_W) noexcept;
  void countNeighbour(const Neighbour& neighbour, double sign) noexcept;
  void hearEnergy(Remote& remote, const StatePacket& packet) noexcept;
  [[nodiscard]] Vec3 limitEnergy(const Vec3& wanted_W) noexcept;

  // What need not be done while nothing moves: site_rest.cpp
  [[nodiscard]] bool mayPark(const SiteBody& body) const noexcept;
  void parkIfItStood(SiteBody& body) noexcept;
  void unpark(SiteBody& body) noexcept;
  void noteWoken(SiteBody& body) noexcept;
  [[nodiscard]] bool isWaiting() const noexcept;
  void waitOn(double dt);
  bool skipBeforeHostStep(double dt) noexcept;
  bool skipAfterHostStep(double dt) noexcept;
  void fallQuiet();

  // What is around: site_surroundings.cpp
  void makeRoomFor(double host_step_time);
  void mirrorIsland() noexcept;
  void updateSurroundings(double dt);
  bool searchObstacles(double horizon, double way);
  void takeObstacles() noexcept;
  void finishSurroundings(bool changed) noexcept;
  [[nodiscard]] std::size_t countHapticBodies() const noexcept;
  [[nodiscard]] bool isFullSearch() const noexcept;
  [[nodiscard]] double computeSpeedInSprings() noexcept;
  void updateNeighbours(double horizon);
  void catchUp();
  void readStates(double time, std::vector<RigidState>& states);

  // Those who come and go: site_neighbours.cpp
  void dropMissingNeighbours();
  void promote(btRigidBody& rigid, Neighbour& neighbour);
  void hold(btRigidBody& rigid, Neighbour& neighbour);
  void takeNewcomers() noexcept;
  void demoteLeaving();
  void unfilter(Neighbour& neighbour);
  void takeOut(Neighbour& neighbour) noexcept;
  void giveBack(Neighbour& neighbour);
  [[nodiscard]] GivenImpulse computeOwed(const SiteBody& body) noexcept;
  void demoteAll();
  void lookAtDriven(double step_end) noexcept;
  void steerDriven() noexcept;
  void followDamping(Neighbour& neighbour) noexcept;

  // The end of the host's world: site_world_end.cpp
  void hostWorldEnds() noexcept override;
  void lookForTheLastTime();

  // The same with a native contact model: site_native.cpp
  void addNativeProxy(Remote& remote, const Vec3& start_W);
  void beforeNativeStep(double dt) noexcept;
  void afterNativeStep(double dt) noexcept;
  void holdNativeGhosts() noexcept;

  template <typename Visit>
  void forEachBody(Visit visit) {
    for (SharedObject& object : objects) visit(object.body);
    for (Neighbour& neighbour : neighbours)
      if (neighbour.is_held) visit(neighbour.body);
    for (Remote& remote : remotes)
      if (remote.proxy) visit(remote.body);
  }

  /// Nothing shared and nobody connected: a hand alone.
  [[nodiscard]] bool isBare() const noexcept { return objects.empty() && remotes.empty(); }
  /// The island stands still for good.
  [[nodiscard]] bool hasStopped() const noexcept { return (status_now & kForGood) != 0; }
  [[nodiscard]] double period() const noexcept { return 1.0 / settings.haptic_rate; }
  /// The latest one, or a usual one until there is one [s].
  [[nodiscard]] double expectedHostStep() const noexcept {
    return host_step > 0.0 ? host_step : 1.0 / 60.0;
  }
  [[nodiscard]] bool isHandoff() const noexcept {
    return !native && settings.injection == Injection::kHandoff;
  }

  SiteSettings settings;
  const Scheme& scheme;
  HapticDevice& device;
  HostWorld host_world;
  Obstacles obstacles;
  NeighbourSearch neighbour_search;
  Island island;
  BodyIndex hip = 0;
  std::vector<SharedObject> objects;
  std::vector<Neighbour> neighbours;  ///< one per slot of the island
  std::vector<Remote> remotes;
  std::unique_ptr<NativeModel> native;  ///< null with the island
  ForceGuard guard;
  PassivityObserver passivity;
  StateHash hash;
  SiteCounters counters;
  std::vector<std::string> last_warnings;  ///< of bodies, from the end of the world on
  Recording* recording = nullptr;

  IslandDesk desk;
  std::uint32_t status_now = kTickOk, status_ever = kTickOk;
  std::atomic<std::uint32_t> status_of_host{kTickOk};  ///< what the host's thread noticed
  std::uint64_t ticks = 0;
  std::uint64_t packets_due = 0;
  int idle_notices = 0;     ///< to be sent before states become rare
  bool is_idle = false;     ///< states go out at the keep-alive rate
  double busy_until = 0.0;  ///< since then nothing has moved or touched
  double start_time = 0.0;
  DeviceSample sample;
  bool world_pushes = false;          ///< some force of the world was ever on some body
  std::optional<Vec3> hand_before_W;  ///< where the hand was a tick ago, if that is known
  Vec3 contact_W = Vec3::Zero();      ///< contact force on the device as the model has it [N]
  Vec3 force_W = Vec3::Zero();        ///< as rendered [N]

  bool lets_go = false;  ///< the force fades to zero, and stays there
  bool makes_up = true;  ///< ticks that were left out are moved over

  double island_time = 0.0;
  double tick_start = 0.0;
  std::vector<RigidState> tick_start_states;
  std::vector<BodyIndex> moved_last;  ///< awake when the last tick began
  double host_time = 0.0;             ///< host's simulated time
  double host_step = 0.0;             ///< its latest step; 0: not known
  double handoff_due = 0.0;           ///< next moment at which a host step ends
  double host_force_end = 0.0;        ///< without news from the host its forces end then
  bool has_host_forces = false;       ///< they have not ended yet
  double host_force_settled = 0.0;    ///< island time up to which they are booked
  double host_lateness = 0.0;         ///< by which the host's forces come late
  double least_late = 1e300;          ///< of a live host, in the present watch [s]
  double watched_host = 0.0;          ///< length of that [s]
  bool has_host_jumped = false;       ///< its clock was set on in the present step
  Snapshots snapshots;
  /// The island as the host's thread knows it.
  struct Mirror {
    std::vector<RigidState> states;  ///< by body
    std::vector<char> moves;         ///< by body, awake then
    double speed = 0.0;              ///< largest [m/s]
  } mirror;
  std::vector<RigidState> from_states, to_states;
  std::vector<Aside> asides;
  PacketTurns packet_turns;

  // The island slept since ...
  RestMark force_rest;     ///< the force was computed
  RestMark hash_rest;      ///< its states went into the hash
  RestMark start_rest;     ///< tick_start_states were kept
  RestMark snapshot_rest;  ///< states were kept for the ends of host steps
  RestMark quiet_rest;     ///< all bodies slept in Bullet, too
  bool may_skip = false;   ///< the next host step, if nothing has changed
  bool quiet = false;      ///< the present host step is skipped
  StandingWatch standing_watch;
  std::vector<HapticBody*> quiet_bodies;
  std::vector<NeighbourSeed> seeds;
  std::vector<BodyIndex> newcomers;  ///< slots filled since they were caught up last
  std::vector<Neighbour*> leaving;   ///< of the host's thread: to be demoted
  std::vector<BodyRecord> object_records, proxy_records;
};

}  // namespace tandem
