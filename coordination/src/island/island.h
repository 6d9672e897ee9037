#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "tandem/coordination/island_counters.h"
#include "tandem/coordination/shape.h"

#include "island/contact_finder.h"
#include "island/virtual_coupler.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Index of a coupler in its island, in the order in which couplers were added.
using CouplerIndex = int;

/// How a body of the island moves.
enum class Motion {
  kDynamic,     ///< by the forces on it
  kPrescribed,  ///< goes on at its velocities from the state last set: the local haptic interface
                ///< point inside a tick, or what the host moves by hand
  kHeld,  ///< stays where it was last set, while its velocity counts in dampers and friction: a
          ///< received state, or a belt
};

/// A body of the island. Plain value; checked by Island::addBody.
struct IslandBody {
  Shape shape = Sphere{0.01};
  Motion motion = Motion::kDynamic;
  double mass = 0.0;              ///< [kg], > 0 if dynamic
  Vec3 inertia_B = Vec3::Zero();  ///< principal moments [kg m^2]; zero: no turning about that axis
  double damping = 0.0;           ///< force against the velocity, b [N s/m], >= 0
  double angular_damping = 0.0;   ///< rate at which turning dies away: w' -= rate w [1/s], >= 0
  bool feels_obstacles = false;   ///< a sphere that touches obstacles through Island::setObstacles
  bool touches_spheres = true;    ///< of a slot's body: spheres with `feels_obstacles` touch it
  bool is_rigid = false;          ///< has rigid contacts, which a ContactFinder finds
  RigidState start;
};

/// A spring-damper from a body to a target that is set from outside and held in between. The
/// angular part turns the body towards the target's orientation: t = K_r theta + B_r (w_target -
/// w), theta the rotation vector from body to target [N m/rad, N m s/rad].
struct CouplerSettings {
  CouplerGains linear;
  CouplerGains angular;
};

/// Something fixed that spheres with `feels_obstacles` touch.
struct Obstacle {
  Shape shape;
  Vec3 p_WB = Vec3::Zero();
  Quat q_WB = Quat::Identity();
};

/// How far a body is off the way that it is known to have gone.
struct Aside {
  Vec3 offset_W = Vec3::Zero();  ///< [m]
  Vec3 v_W = Vec3::Zero();       ///< [m/s]
  Vec3 w_W = Vec3::Zero();       ///< [rad/s]
};

/// A smooth contact of a sphere with another body, as it was added.
struct IslandContact {
  BodyIndex sphere = 0;
  BodyIndex other = 0;
  CouplerGains gains;
};

struct IslandSettings {
  double haptic_period = 1e-3;       ///< [s]; the exact maps are built for it and its binary parts
  double inner_step = 1.0 / 4000.0;  ///< longest step near rigid contact [s]; smaller is more exact
  double tolerance = 2e-10;   ///< error of one step of smooth contact [m]; smaller is more exact
  std::optional<Vec3> guide;  ///< unit vector: bodies keep only this direction, no rotation
  CouplerGains obstacle_contact;  ///< K_vc, B_vc of spheres on obstacles
};

/// The small set of bodies that must be right at the haptic rate: haptic interface point, remote
/// dynamic proxies, touched object copies; with the couplers and smooth contacts between them.
///
/// Motion is exact between events (contact made, contact broken, target set) wherever it is linear:
/// a body alone with its couplers, and everything in a guide. Elsewhere - free bodies in touch - it
/// is integrated (Runge-Kutta 5(4), steps as long as IslandSettings::tolerance allows) with
/// contacts made and broken located inside the step. Rigid contact is solved in inner
/// steps, by sequential impulses. State is `double`, in W. Deterministic to the bit. Not thread
/// safe; whoever ticks owns the island. After prepare(), nothing allocates or throws until a body,
/// coupler or contact is added.
///
/// A free island (no guide) in which nothing moves falls asleep, and advance() does nothing: all
/// dynamic bodies slower than 1e-9 m/s and 1e-9 rad/s and accelerated by less than 1e-6 m/s^2 and
/// rad/s^2, with less than 5e-13 m to go to their rest (a body without coupler: standing still to
/// rounding), prescribed bodies still. A call that really changes a value wakes it before the next
/// advance; the same value again does not.
class Island {
 public:
  /// Throws std::invalid_argument, naming the value, for settings out of range.
  explicit Island(const IslandSettings& settings);
  ~Island();
  Island(Island&&) noexcept;
  Island& operator=(Island&&) noexcept;

  /// @name Set-up; each may allocate, and throws std::invalid_argument naming the value.
  /// @{
  BodyIndex addBody(const IslandBody& body);
  CouplerIndex addCoupler(BodyIndex follower, const CouplerSettings& settings);
  /// Unilateral contact of a sphere body with any other body: eqs (7), (8), (11), (12).
  void addContact(BodyIndex sphere, BodyIndex other, const CouplerGains& gains);
  /// Room for a body that comes and goes while the island runs (a neighbour of the host's world,
  /// promoted before it is touched). Not active until filled. Spheres with `feels_obstacles`
  /// touch it by the law and gains of obstacles (IslandSettings::obstacle_contact), and it feels
  /// the reaction, force and torque. Not in a guided island.
  BodyIndex addSlot();
  /// Who finds rigid contacts; may be null: there are none. Must outlive the island.
  void setContactFinder(ContactFinder* finder);
  /// Builds the exact maps for what has been added.
  void prepare();
  /// @}

  /// @name In the tick: real-time safe.
  /// @{
  void setState(BodyIndex body, const RigidState& state) noexcept;
  void setTarget(CouplerIndex coupler, const RigidState& target) noexcept;
  /// Force and torque about the centre of mass from outside, in W, until set again [N, N m].
  void setExternalWrench(BodyIndex body, const Vec3& f_W, const Vec3& t_W) noexcept;
  /// Adds momentum at once [N s, N m s].
  void applyImpulse(BodyIndex body, const Vec3& impulse_W, const Vec3& angular_W) noexcept;
  /// Multiplies the gains of a coupler, linear and angular, by a share in 0 to 1 of what they were
  /// added with, until set again. At 1 everything is as if there were no share, to the bit.
  void setCouplerShare(CouplerIndex coupler, double share) noexcept;
  /// The same for the gains of all smooth contacts of a body. Of a contact of two bodies with
  /// shares both count.
  void setContactShare(BodyIndex body, double share) noexcept;
  /// Damping against the velocity besides the body's own [N s/m], >= 0, until set again.
  void setExtraDamping(BodyIndex body, double damping) noexcept;
  /// A ghost stays where it is set, whatever pulls at it, and meets nothing. One that ends being a
  /// ghost goes on from there, at the velocity that was set. Not for slots, prescribed bodies and
  /// bodies with rigid contacts.
  void setGhost(BodyIndex body, bool is_ghost) noexcept;
  /// Replaces the obstacles that spheres touch; the vector must live until the next call.
  void setObstacles(const std::vector<Obstacle>& obstacles) noexcept;
  /// Makes the slot this body, at its start state and with nothing from outside on it; from the
  /// next advance it moves as any body without couplers. The body must be as addBody accepts it
  /// (asserted, not thrown); `feels_obstacles` is not looked at. Filling a filled slot replaces its
  /// body.
  void fill(BodyIndex slot, const IslandBody& body) noexcept;
  /// Makes the slot inactive: it moves nothing, touches nothing, costs nothing; its state is
  /// RigidState{} until it is filled again.
  void clear(BodyIndex slot) noexcept;
  /// Ends sleep where the island cannot see why: what the ContactFinder knows has changed.
  void wake() noexcept;
  /// Moves everything by `dt` [s], 0 < dt <= haptic_period.
  void advance(double dt) noexcept;
  /// Moves these slots by `duration` [s] in the past, for bodies that come with an older state than
  /// the island's: with each other, what stands, and all other bodies. The others went `from` a
  /// state `to` another meanwhile, steadily, and turn aside where the slots touch them: by how much
  /// so far is added to `asides`. All by index; of the slots themselves nothing is read there. The
  /// island's own states of the others, their couplers and contacts, are left as they are.
  void catchUp(const std::vector<BodyIndex>& slots, const std::vector<RigidState>& from,
               const std::vector<RigidState>& to, double duration,
               std::vector<Aside>& asides) noexcept;
  /// @}

  /// What it did since prepare().
  [[nodiscard]] const IslandCounters& counters() const noexcept;

  /// True if the next advance has nothing to do.
  [[nodiscard]] bool isAsleep() const noexcept;
  /// Those that the next advance looks at, in order: all but empty slots, and bodies that are at
  /// rest with nothing near. Only these may have another state than before the last advance.
  [[nodiscard]] const std::vector<BodyIndex>& awakeBodies() const noexcept;

  [[nodiscard]] const RigidState& state(BodyIndex body) const noexcept;
  /// What a coupler pulls to now: the target last set, its follower's start before that.
  [[nodiscard]] const RigidState& target(CouplerIndex coupler) const noexcept;
  /// Bodies and slots.
  [[nodiscard]] int bodyCount() const noexcept;
  [[nodiscard]] bool isSlot(BodyIndex body) const noexcept;
  /// As it was added or filled.
  [[nodiscard]] const IslandBody& body(BodyIndex body) const noexcept;
  [[nodiscard]] int couplerCount() const noexcept;
  [[nodiscard]] BodyIndex follower(CouplerIndex coupler) const noexcept;
  /// As it was added, whatever its share.
  [[nodiscard]] const CouplerSettings& couplerSettings(CouplerIndex coupler) const noexcept;
  [[nodiscard]] double couplerShare(CouplerIndex coupler) const noexcept;
  [[nodiscard]] double contactShare(BodyIndex body) const noexcept;
  /// As set last; no torque on a body that does not turn.
  [[nodiscard]] const Vec3& externalForce(BodyIndex body) const noexcept;
  [[nodiscard]] const Vec3& externalTorque(BodyIndex body) const noexcept;
  [[nodiscard]] double extraDamping(BodyIndex body) const noexcept;
  [[nodiscard]] bool isGhost(BodyIndex body) const noexcept;
  [[nodiscard]] const std::vector<IslandContact>& contacts() const noexcept;
  /// As set last; null before.
  [[nodiscard]] const std::vector<Obstacle>* obstacles() const noexcept;
  /// True if forces move it: dynamic, and neither an empty slot nor a ghost.
  [[nodiscard]] bool isDynamic(BodyIndex body) const noexcept;
  /// False for a slot that is not filled.
  [[nodiscard]] bool isActive(BodyIndex body) const noexcept;

  /// Sum of the contact forces on a body at this instant, in W [N].
  [[nodiscard]] Vec3 computeContactForce(BodyIndex body) const noexcept;
  /// How deep a body is in what it has smooth contacts with [m], were it no ghost; 0: in nothing.
  /// Other ghosts do not count. Real-time safe.
  [[nodiscard]] double computeOverlap(BodyIndex body) const noexcept;
  /// Force of a coupler on its follower at this instant, in W [N].
  [[nodiscard]] Vec3 computeCouplerForce(CouplerIndex coupler) const noexcept;
  /// All forces and torques on a dynamic body at this instant, external and damping included [N, N
  /// m].
  void computeWrench(BodyIndex body, Vec3& f_W, Vec3& t_W) const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
