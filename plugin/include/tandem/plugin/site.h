#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tandem/bullet_bridge/bullet_abi.h"
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

/// What a tick has to report; each bit says what to do.
enum TickStatus : std::uint32_t {
  kTickOk = 0,
  kDeviceInvalid =
      1u << 0,  ///< the device gave nothing usable: check its cable; no force until it does
  kBodyMissing =
      1u << 1,  ///< a body of ours was taken out of the host's world: put it back, make a new Site
  kPacketRefused =
      1u << 2,  ///< a packet held nonsense (not finite, no unit quaternion): check the sender
  kHostStepWrong = 1u << 3,  ///< impulse injection, but the host does not step at the haptic rate:
                             ///< make it, or hand off
  kStateNotFinite =
      1u << 4,           ///< the island blew up: lower gains or inner_step; the force stays at zero
  kWorldGone = 1u << 5,  ///< the host has destroyed its world before this site: the force fades to
                         ///< zero, if somebody else than its steps ticks; destroy a site before
                         ///< its world
};

/// Counts since the start.
struct SiteCounters {
  std::uint64_t packets_sent = 0;
  std::uint64_t packets_taken = 0;
  std::uint64_t packets_stale = 0;    ///< nothing in it newer than what was there: dropped
  std::uint64_t packets_refused = 0;  ///< not sane: dropped
  std::uint64_t host_steps = 0;
  std::uint64_t host_steps_skipped = 0;  ///< of these, with nothing to do: all slept
  std::uint64_t searches = 0;            ///< for what is around, in the host's world
  std::uint64_t bodies_handed_off = 0;   ///< one by one
  std::uint64_t bodies_parked = 0;       ///< put to sleep in Bullet, one by one
  std::uint64_t bodies_woken = 0;        ///< of those
  std::uint64_t host_clock_set = 0;      ///< the host had dropped time: its clock was set on
  std::uint64_t ticks_made_up = 0;       ///< left out by the caller, and moved over by the next
  std::uint64_t links_faded = 0;         ///< remotes whose gains began to fall, each time
  std::uint64_t links_lost = 0;          ///< and came to zero
  std::uint64_t links_rejoined = 0;      ///< heard again after that, or at last
  std::uint64_t force_clamped = 0;       ///< ticks in which the force was beyond the device's limit
  std::uint64_t force_slewed = 0;        ///< in which it would have changed too fast
  std::uint64_t energy_limited = 0;      ///< in which the hand was about to get too much energy
  std::uint64_t promoted = 0;            ///< bodies of the host that the island took
  std::uint64_t demoted = 0;             ///< and those that it gave back
};

/// One user's side of a networked haptic cooperation, attached to a host's Bullet world.
///
/// A tick reads the device, takes in what has arrived, renders the force, advances the island -
/// taking in what arrives and sending what is due at its moment - and Bullet gets its share in the
/// host's step. Shared objects and remote users are ordinary btRigidBodys of the host's world.
///
/// Set-up calls may allocate and throw; tick() does neither. One thread calls everything of one
/// site, the one that steps the world; with a HapticLoop there are two. Several sites may live in
/// several threads, each with a world of its own.
///
/// World, device, links and shared bodies should outlive the site; destroying the site gives the
/// host everything back as it was. Not while Bullet looks for contact: outside stepSimulation(), or
/// in the host's own tick callbacks and actions. What goes before the site: the world gets
/// everything back in that moment, and the site says so (kWorldGone); a body taken out of its world
/// is left alone from the next step on (kBodyMissing), and may be deleted - with the joints of
/// ContactModel::kSpring6Dof and kPointToPoint, and with a guide and a native model, not before the
/// site; device and links may go once nobody ticks any more.
///
/// With nothing shared and nobody connected the hand feels what stands in the world, and the host's
/// simulation is the same to the bit (with a native model the hand is a body of it). Multi-bodies,
/// soft bodies and bodies in joints are never taken in: shared bodies meet them in Bullet, the hand
/// does not feel them.
class Site {
 public:
  /// Throws std::invalid_argument for settings out of range; tandem::Error if the device gives no
  /// position, the world is attached already or the host was compiled for another Bullet than this
  /// library.
  Site(const SiteSettings& settings, btDiscreteDynamicsWorld& world, HapticDevice& device,
       BulletAbi host = bulletAbiOfThisCode());
  ~Site();
  Site(const Site&) = delete;
  Site& operator=(const Site&) = delete;

  /// Shares a dynamic box, sphere, capsule, cylinder or convex hull of the host's world: its mass
  /// and inertia become m/N of what they are, until the site ends. So what hits it here in Bullet -
  /// a body beyond max_neighbours, a multi-body, a cloth - pushes it N times as easily as before;
  /// the momentum of such a hit is that of m/N, and couplers carry it to the other N - 1 copies,
  /// until all move as one of mass m would. `damping` b acts on this copy [N s/m]. Every peer
  /// shares the same objects in the same order: that is their identity. Up to kMaxSharedObjects.
  /// With hand-off the body sleeps in Bullet while it stands, and costs no more than others that
  /// sleep; whatever moves, pushes or hits it wakes it. Throws tandem::Error for a body that cannot
  /// be shared, with the reason.
  ObjectId share(btRigidBody& body, double damping = 0.0);

  /// Connects a remote user whose device starts at `start_W`. The scheme decides what stands for
  /// the user here.
  void connect(PeerId remote, Link& link, const Vec3& start_W);

  /// One haptic period from `now` [s]; the first call starts the clock. Returns TickStatus bits.
  /// Real-time safe. Only with TickSource::kCaller.
  std::uint32_t tick(double now) noexcept;

  /// Runs `work` while no tick runs: what may be called of this site may be called there, but for
  /// set-up. With a HapticLoop that is its thread, and this waits for it, a period at the most; so
  /// `work` must be short, not throw, and not call this. For the thread that steps the world;
  /// others may ask for what ticks make, but not for counts of the host's steps.
  void betweenTicks(const std::function<void()>& work);

  /// All status bits since the start.
  [[nodiscard]] std::uint32_t status() const noexcept;
  /// True once the host has destroyed the world, as kWorldGone says. From any thread.
  [[nodiscard]] bool isWorldGone() const noexcept;
  [[nodiscard]] const SiteCounters& counters() const noexcept;
  /// What the island did and what it could skip.
  [[nodiscard]] const IslandCounters& islandCounters() const noexcept;
  [[nodiscard]] std::uint64_t tickCount() const noexcept;

  /// FNV-1a over the bits of time and force of all ticks, and of the states of all that was awake
  /// in the island then: equal runs have equal hashes.
  [[nodiscard]] std::uint64_t stateHash() const noexcept;

  /// Things a user should know about what was attached, one line each.
  [[nodiscard]] std::vector<std::string> warnings() const;

  /// Bodies of the host that the island holds now, besides shared ones; see
  /// SiteSettings::max_neighbours.
  [[nodiscard]] int neighbourCount() const noexcept;

  /// The latest tick's force on the device, in W [N], and whether it is a contact force above 0.
  [[nodiscard]] const Vec3& force() const noexcept;
  /// Haptic interface point, shared object and proxy in the island, now.
  [[nodiscard]] const RigidState& hip() const noexcept;
  [[nodiscard]] const RigidState& object(ObjectId id) const noexcept;
  [[nodiscard]] int objectCount() const noexcept;
  [[nodiscard]] int remoteCount() const noexcept;
  /// Null where the scheme has no body for a remote user.
  [[nodiscard]] const RigidState* proxy(int remote) const noexcept;
  [[nodiscard]] btRigidBody* proxyBody(int remote) const noexcept;
  [[nodiscard]] btRigidBody& objectBody(ObjectId id) const noexcept;
  /// How a remote is doing as of the latest tick; always live with SiteSettings::link_loss off.
  [[nodiscard]] LinkState linkState(int remote) const noexcept;
  /// Account of energy: what this side has put in, what its hand may get now, the least of it ever.
  [[nodiscard]] const PassivityObserver& passivity() const noexcept;
  /// The newest state received from a remote; nothing is known before the first packet.
  [[nodiscard]] const StatePacket& latest(int remote) const noexcept;

  /// Records each tick from now on; null stops. Must outlive the site or be taken away before.
  void record(Recording* recording) noexcept;

 private:
  friend class HapticLoop;
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
