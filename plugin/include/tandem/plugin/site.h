#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tandem/bullet_bridge/bullet_abi.h"
#include "tandem/coordination/configuration.h"
#include "tandem/plugin/site_settings.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

class HapticDevice;
class HapticLoop;
class Link;
class PassivityObserver;
class Recording;
struct IslandCounters;
struct StatePacket;

/// Report of a tick. Each bit names the remedy.
enum TickStatus : std::uint32_t {
  kTickOk = 0,
  kDeviceInvalid = 1u << 0,   ///< no usable device reading, no force: check the device's cable
  kBodyMissing = 1u << 1,     ///< a body of ours is not in the host's world: see warnings()
  kPacketRefused = 1u << 2,   ///< a packet was invalid (NaN, no unit quaternion): check the sender
  kHostStepWrong = 1u << 3,   ///< impulse injection without host steps at the haptic rate: hand off
  kStateNotFinite = 1u << 4,  ///< the island diverged, no force any more: lower gains or inner_step
  kWorldGone = 1u << 5,   ///< the world is gone, the force fades: destroy a site before its world
  kOutOfRange = 1u << 6,  ///< a body is too far or fast for packets: move the world to its origin
};

/// Counters since the start.
struct SiteCounters {
  std::uint64_t packets_sent = 0;
  std::uint64_t packets_taken = 0;
  std::uint64_t states_withheld = 0;  ///< of own bodies, not sent: out of the range of packets
  std::uint64_t packets_stale = 0;    ///< dropped: nothing newer than what was known
  std::uint64_t packets_refused = 0;  ///< dropped: invalid
  std::uint64_t peer_jumps = 0;       ///< states of peers too far from the ones before: smoothed
  std::uint64_t host_steps = 0;
  std::uint64_t host_steps_skipped = 0;  ///< host steps without work, because all bodies slept
  std::uint64_t searches = 0;            ///< searches of the host's world for surroundings
  std::uint64_t bodies_handed_off = 0;   ///< counted per body and step
  std::uint64_t bodies_parked = 0;       ///< bodies put to sleep in Bullet, each time
  std::uint64_t bodies_woken = 0;        ///< parked bodies woken, each time
  std::uint64_t host_clock_set = 0;      ///< clock resets because the host dropped time
  std::uint64_t ticks_made_up = 0;       ///< ticks skipped by the caller, covered by the next tick
  std::uint64_t links_faded = 0;         ///< times that a remote's gains began to fade
  std::uint64_t links_lost = 0;          ///< times that a remote's gains reached zero
  std::uint64_t links_rejoined = 0;      ///< remotes heard again after that, or for the first time
  std::uint64_t force_clamped = 0;       ///< ticks with a force above the device's limit
  std::uint64_t force_slewed = 0;        ///< ticks in which the force changed too fast
  std::uint64_t energy_limited = 0;      ///< ticks in which the energy limit acted
  std::uint64_t promoted = 0;            ///< host bodies taken into the island
  std::uint64_t demoted = 0;             ///< host bodies given back to Bullet
  std::uint64_t objects_left = 0;        ///< times that a shared object was left to Bullet
  std::uint64_t objects_reset = 0;       ///< times that the host put a shared object elsewhere
  std::uint64_t peers_restarted = 0;     ///< times that a peer counted its packets from 0 again
  std::uint64_t resets_followed = 0;     ///< times that a peer's host did so
  std::uint64_t members_changed = 0;     ///< times that N changed: SiteSettings::membership
  std::uint64_t grips_broken = 0;        ///< times that the local hand's grip was pulled too hard
};

/// A body with the name by which all peers know its object.
struct NamedBody {
  std::string name;  ///< 1 to 57 characters of A-Z a-z 0-9 . _ -
  btRigidBody* body = nullptr;
  double damping = 0.0;  ///< of this copy [N s/m]
};

/// An object in the local user's hand, at the latest tick.
struct Grip {
  ObjectId object = 0;
  Vec3 p_BG = Vec3::Zero();      ///< place that the hand holds, from the centre of mass, in B [m]
  Vec3 force_W = Vec3::Zero();   ///< on the object; the hand gets -force before its limits [N]
  Vec3 torque_W = Vec3::Zero();  ///< on the object, besides that of the force [N m]
  bool is_fading = false;        ///< the hand has let go
};

/// Items for a mesh's configuration, by which peers compare the names of their objects before they
/// are coupled: "object.cube", "shared". Throws std::invalid_argument for an invalid name.
[[nodiscard]] std::vector<ConfigurationItem> describeObjects(const std::vector<std::string>& names);

/// One user's side of a networked haptic cooperation, attached to a Bullet world of the host.
///
/// A tick reads the device, takes the packets that arrived, renders the force and advances the
/// island. Within the tick each packet is taken or sent at its own time. Bullet gets the result in
/// the host's step. Shared objects and remote users are ordinary btRigidBody objects of the host's
/// world.
///
/// Set-up calls may allocate and throw; tick() does neither. One thread makes all calls of a site:
/// the thread that steps the world. With a HapticLoop there are two threads. Several sites may run
/// in several threads, each with its own world.
///
/// World, device, links and shared bodies should outlive the site. Destroying the site restores the
/// host's bodies. Do that outside stepSimulation() or in the host's own tick callbacks and actions,
/// never while Bullet looks for contacts.
///
/// If the world is destroyed first, its bodies are restored at that moment and the site reports
/// kWorldGone. A body removed from its world is ignored from the next step on (kBodyMissing), and
/// may then be deleted. Put back, the same or another at its address, it is shared again; see
/// isHeld(). With a guide or a native model the site stops instead. With the joints of
/// ContactModel::kSpring6Dof and kPointToPoint, and with a guide and a native model, it must
/// outlive the site. Device and links may go once nothing ticks the site.
///
/// With nothing shared and nobody connected the hand feels the bodies of the world, and pushes the
/// moving ones. While it is near none of those, or SiteSettings::hand_feels_moving_bodies is false,
/// the host's simulation is the same to the bit. Native models add the hand as a body, though. The
/// island takes bodies in joints and multi-bodies whole, or not at all; warnings() says why not. It
/// never takes soft bodies: shared bodies meet those in Bullet, and the hand does not feel them.
class Site {
 public:
  /// Throws std::invalid_argument for settings out of range. Throws tandem::Error if the device
  /// gives no position, the world has a site already, or the host was compiled for another Bullet.
  Site(const SiteSettings& settings, btDiscreteDynamicsWorld& world, HapticDevice& device,
       BulletAbi host = bulletAbiOfThisCode());
  ~Site();
  Site(const Site&) = delete;
  Site& operator=(const Site&) = delete;

  /// Shares a dynamic body of the host's world, of any convex shape, or a compound of any shapes
  /// but planes, of which hand and proxies feel each part. Its mass and inertia become m/N of their
  /// value until the site ends. A body that hits it here in Bullet therefore pushes it N times as
  /// easily: a body beyond max_neighbours, a cloth. The hit's momentum is that of m/N; couplers
  /// share it with the other N - 1 copies until all move as one mass m would.
  ///
  /// `damping` b acts on this copy [N s/m]. All peers share the same objects in the same order,
  /// which identifies them, or by name. At most kMaxSharedObjects. With hand-off the body sleeps in
  /// Bullet while it rests and costs no more than any sleeping body; motion, pushes and hits wake
  /// it. Throws tandem::Error with the reason for a body that cannot be shared.
  ObjectId share(btRigidBody& body, double damping = 0.0);

  /// Shares bodies by name, in any order: an object's id is the place of its name among all names
  /// in rising order. So peers that share the same names pair the same objects; describeObjects()
  /// lets a mesh compare the names. Returns the ids in the order of `bodies`. Comes before any
  /// other share(). Throws as that one, and for an invalid name or one that occurs twice; then
  /// nothing is shared.
  std::vector<ObjectId> share(const std::vector<NamedBody>& bodies);

  /// Gives a user a tool: a dynamic body of this host's world, of any shape that share() takes. At
  /// the user's own site (SiteSettings::self) the hand holds it from the first tick on, as by
  /// grab(), with SiteSettings::tool; at the others the user's proxy holds theirs. So the user
  /// touches things with the body, rigidly and with its friction, and feels them through the hold
  /// alone. What is seen goes into nothing. Hand and proxy touch nothing meanwhile.
  ///
  /// The tool turns with a device that tells its wrist. Another keeps the tool as it is turned at
  /// the start; an angular factor of 0 makes it stiff. A device with torque feels the hold's. The
  /// tool keeps its whole mass at each site, and no coupler ties its copies. Its weight is felt: a
  /// body without gravity has none. `at_B` is the handle, from the centre of mass in the tool's
  /// frame [m].
  ///
  /// All peers share tools and objects in the same order. release() lays the tool down, grab()
  /// takes it up. Throws as share() and grab() do.
  ObjectId shareTool(btRigidBody& body, PeerId user, const Vec3& at_B = Vec3::Zero());

  /// Gives a shared object back to Bullet, with its own mass and the velocity that it has. Peers
  /// let go of their copies after 16 packets without it, and the other objects stay shared. At any
  /// time between two steps of the host, also with a HapticLoop; the body may be deleted at once.
  /// Does nothing if it is not shared. A body that was taken out of the world before gets its mass
  /// back once it returns, or keeps its m/N if the site ends before. Throws tandem::Error for an
  /// unknown id, and with a guide or a native model.
  void unshare(ObjectId id);

  /// Shares a body for an object that was unshared, or whose body is not in the world: the same or
  /// another. It keeps the object's damping. Peers meet it as they meet one that comes back. At any
  /// time between two steps of the host; it is held from the next step on. Throws tandem::Error
  /// with the reason if the body cannot be shared, and as unshare() does.
  void share(ObjectId id, btRigidBody& body);

  /// For hosts that keep their numbers small: tells that the host has moved all of its world by
  /// `offset_W` [m], every body with its velocity, since its last step. Touch, couplers and forces
  /// go on as if nothing had happened. The site moves its proxies itself, and adds the offset to
  /// the device's positions from now on. Packets stay in the frame in which the site began, within
  /// 1000 m of its origin, so peers never notice. At any time between two steps of the host, also
  /// with a HapticLoop. Throws std::invalid_argument for an offset that is not finite, and
  /// tandem::Error with a native model.
  void shiftOrigin(const Vec3& offset_W);

  /// Lets the hand hold a shared object by its place `at_B`, from the centre of mass in the
  /// object's frame [m]; without one, where the hand is. A spring-damper (SiteSettings::grip) keeps
  /// the place at the hand, and the object's orientation as it is now: it turns only with a device
  /// that tells its wrist. The object comes to a hand that is elsewhere within 0.1 s. Its
  /// weight passes to the hand, so that it does not sag. Hand and object do not touch meanwhile.
  ///
  /// The force on the object is minus that on the hand in each tick, before the device's limits.
  /// The limit belongs to the grip: pulled at it for 0.1 s, the grip breaks. It ends as well when
  /// the object is unshared, left to Bullet or put elsewhere. At the peers the user's proxy takes
  /// the same hold of their copy. Recordings do not hold grips.
  ///
  /// At any time between two steps of the host, also with a HapticLoop; waits for it as
  /// betweenTicks() does. Throws tandem::Error if the object is not shared, left to Bullet or
  /// another user's tool, if the hand holds another one, and with a guide, a native model or
  /// impulse injection. Throws
  /// std::invalid_argument for a place that is not finite or beyond 1000 m.
  void grab(ObjectId object, const std::optional<Vec3>& at_B = std::nullopt);

  /// Lets go of what the hand holds; the force fades within 50 ms. Does nothing without a grip. May
  /// be called as grab() may.
  void release() noexcept;

  /// What the hand holds; empty without a grip, and once one has faded. For the thread that ticks,
  /// or in betweenTicks().
  [[nodiscard]] std::optional<Grip> grip() const noexcept;

  /// Connects a remote user whose device starts at `start_W`. The scheme chooses the user's
  /// stand-in.
  void connect(PeerId remote, Link& link, const Vec3& start_W);

  /// Advances one haptic period from `now` [s]; the first call starts the clock. Returns TickStatus
  /// bits. Real-time safe. Only with TickSource::kCaller. A time that is not finite, or beyond 1e10
  /// s, counts as a period after the last tick.
  std::uint32_t tick(double now) noexcept;

  /// Runs `work` while no tick runs. It may make any call of this site except set-up. With a
  /// HapticLoop, `work` runs on the loop's thread and this call waits for it, at most a period.
  /// `work` must be short, must not throw and must not call this. Meant for the thread that steps
  /// the world. Other threads may read results of ticks, but no counters of host steps.
  void betweenTicks(const std::function<void()>& work);

  /// All status bits since the start.
  [[nodiscard]] std::uint32_t status() const noexcept;
  /// True once the host has destroyed the world (kWorldGone). For any thread.
  [[nodiscard]] bool isWorldGone() const noexcept;
  [[nodiscard]] const SiteCounters& counters() const noexcept;
  /// Work that the island did, and work that it could skip.
  [[nodiscard]] const IslandCounters& islandCounters() const noexcept;
  [[nodiscard]] std::uint64_t tickCount() const noexcept;

  /// FNV-1a hash over the bits of time and force of all ticks, and over all awake states in the
  /// island. Equal runs have equal hashes.
  [[nodiscard]] std::uint64_t stateHash() const noexcept;

  /// Facts about the attached world that a user should know, one line each. Names each object whose
  /// body is missing (kBodyMissing) or left to Bullet.
  [[nodiscard]] std::vector<std::string> warnings() const;

  /// Number of host bodies in the island now, without shared ones; see
  /// SiteSettings::max_neighbours.
  [[nodiscard]] int neighbourCount() const noexcept;

  /// Force on the device in the latest tick, in W [N].
  [[nodiscard]] const Vec3& force() const noexcept;
  /// Torque on the device in the latest tick, in W [N m]; 0 if it renders none.
  [[nodiscard]] const Vec3& torque() const noexcept;
  /// Current island states of the haptic interface point, a shared object and a proxy.
  [[nodiscard]] const RigidState& hip() const noexcept;
  [[nodiscard]] const RigidState& object(ObjectId id) const noexcept;
  [[nodiscard]] int objectCount() const noexcept;
  /// False after unshare().
  [[nodiscard]] bool isShared(ObjectId id) const noexcept;
  /// False while a shared object is left to Bullet, because the island cannot hold its body: it is
  /// not in the world, static, kinematic, without contact response, or has DISABLE_SIMULATION.
  /// Peers follow it there, but do not move it. For the thread that steps the world.
  [[nodiscard]] bool isHeld(ObjectId id) const noexcept;
  [[nodiscard]] int remoteCount() const noexcept;
  /// N at the latest tick: sites that share the objects, this one too. SiteSettings::membership.
  /// For the thread that ticks, or in betweenTicks().
  [[nodiscard]] int memberCount() const noexcept;
  /// Null if the scheme has no body for a remote user.
  [[nodiscard]] const RigidState* proxy(int remote) const noexcept;
  [[nodiscard]] btRigidBody* proxyBody(int remote) const noexcept;
  /// The host's body of an object that isShared().
  [[nodiscard]] btRigidBody& objectBody(ObjectId id) const noexcept;
  /// State of a remote as of the latest tick; always live if SiteSettings::link_loss is off.
  [[nodiscard]] LinkState linkState(int remote) const noexcept;
  /// Energy account: the input of this side, the hand's current budget, and its least value so far.
  [[nodiscard]] const PassivityObserver& passivity() const noexcept;
  /// Newest state received from a remote; empty before its first packet.
  [[nodiscard]] const StatePacket& latest(int remote) const noexcept;

  /// Records every tick from now on; null stops. `recording` must outlive the site or be removed
  /// first.
  void record(Recording* recording) noexcept;

 private:
  friend class HapticLoop;
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
