#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "tandem/coordination/island_counters.h"
#include "tandem/coordination/shape.h"

#include "island/collision_filter.h"
#include "island/contact_finder.h"
#include "island/contact_tally.h"
#include "island/joint_source.h"
#include "island/virtual_coupler.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Index of a coupler in its island, in the order in which couplers were added.
using CouplerIndex = int;

/// Index of a grip in its island, in the order in which grips were added.
using GripIndex = int;

/// Kind of motion of a body in the island.
enum class Motion {
  kDynamic,     ///< moved by forces
  kPrescribed,  ///< keeps its set velocities: the local HIP in a tick, or a kinematic body
  kHeld,        ///< stays where set; its velocity counts in dampers and friction: a received state
};

/// A body of the island. Plain value; Island::addBody checks it.
struct IslandBody {
  Shape shape = Sphere{0.01};
  Motion motion = Motion::kDynamic;
  double mass = 0.0;              ///< [kg], > 0 if dynamic
  Vec3 inertia_B = Vec3::Zero();  ///< principal moments [kg m^2]; zero: no rotation about that axis
  /// Scale of accelerations along, and angular ones about, the axes of W, >= 0. An axis with 0
  /// keeps its velocity, whatever pushes. A guided island knows no factors.
  Vec3 linear_factor = Vec3::Ones(), angular_factor = Vec3::Ones();
  double damping = 0.0;          ///< b of the force -b v [N s/m], >= 0
  double angular_damping = 0.0;  ///< rate of the damping w' = -rate w [1/s], >= 0
  double contact_share = 1.0;    ///< of the gains of its smooth contacts; two bodies' multiply
  bool feels_obstacles = false;  ///< the sphere touches obstacles of Island::setObstacles
  bool touches_spheres = true;   ///< in a slot: spheres with `feels_obstacles` touch it
  bool is_rigid = false;         ///< a ContactFinder finds its rigid contacts
  CollisionFilter filter = {};   ///< for smooth contacts
  RigidState start;

  /// False if all factors are one.
  [[nodiscard]] bool hasFactors() const noexcept {
    return linear_factor != Vec3::Ones() || angular_factor != Vec3::Ones();
  }
};

/// A spring-damper from a body to a target, which stays until set again. The angular part turns the
/// body towards the target's orientation: t = K_r theta + B_r (w_target - w) [N m]. theta is the
/// rotation vector from body to target; K_r [N m/rad], B_r [N m s/rad].
struct CouplerSettings {
  CouplerGains linear;
  CouplerGains angular;
};

/// A spring-damper of six degrees of freedom between a hand and a place G on a body F. The hand is
/// a body whose frame stays parallel to W.
///
///   f = K (p_hand + offset - p_G) + B (v_hand - v_G) + lift      at G, and -f on the hand
///   t = K_r theta + B_r (w - w_F)                                on F, and -t on the hand's wrist
///
/// theta is the rotation vector from F to `q_WF`. The norms of f and t have limits. Hand and body
/// do not touch each other meanwhile.
struct IslandGrip {
  BodyIndex body = 0;            ///< F
  Vec3 p_FG = Vec3::Zero();      ///< G from the centre of mass, in F [m]
  Vec3 offset_W = Vec3::Zero();  ///< of G from the hand, with no force [m]
  Quat q_WF = Quat::Identity();  ///< orientation that the torque leads to
  Vec3 w_W = Vec3::Zero();       ///< w, the rate of that orientation [rad/s]
  Vec3 lift_W = Vec3::Zero();    ///< part of f [N]
  Vec3 load_W = Vec3::Zero();    ///< at G, too, but of no hand here [N]
  CouplerSettings gains;         ///< K, B and K_r, B_r
  double max_force = 0.0;        ///< [N]
  double max_torque = 0.0;       ///< [N m]
  double share = 1.0;            ///< of all forces and their limits; 0: only keeps them apart
  bool is_tool = false;          ///< the hand touches nothing at all: the body does in its place
};

/// Force on the place of a grip and torque on its body, in W.
struct GripPull {
  Vec3 f_W = Vec3::Zero();     ///< [N]
  Vec3 t_W = Vec3::Zero();     ///< [N m]
  Vec3 load_W = Vec3::Zero();  ///< IslandGrip::load_W [N]
  bool is_limited = false;     ///< the force is at its limit
};

/// Whether an obstacle was in the list before.
enum class ObstacleChange : std::uint8_t {
  kNone,   ///< at the same place
  kMoved,  ///< elsewhere
  kNew,    ///< no
};

/// A fixed object that spheres with `feels_obstacles` touch.
struct Obstacle {
  Shape shape;
  Vec3 p_WB = Vec3::Zero();
  Quat q_WB = Quat::Identity();
  std::uint64_t id = 0;  ///< the same in each list; 0: its place in the list tells
  ObstacleChange change = ObstacleChange::kNone;
  /// If it moved: its pose in the list before.
  Vec3 p_before_WB = Vec3::Zero();
  Quat q_before_WB = Quat::Identity();
  CollisionFilter filter = {};
};

/// Deviation of a body from its known path.
struct Aside {
  Vec3 offset_W = Vec3::Zero();  ///< [m]
  Vec3 v_W = Vec3::Zero();       ///< [m/s]
  Vec3 w_W = Vec3::Zero();       ///< [rad/s]
};

/// A smooth contact of a sphere with another body.
struct IslandContact {
  BodyIndex sphere = 0;
  BodyIndex other = 0;
  CouplerGains gains;
};

struct IslandSettings {
  double haptic_period = 1e-3;       ///< [s]; exact maps exist for it and its binary fractions
  double inner_step = 1.0 / 4000.0;  ///< longest step near rigid contact [s]; less is more exact
  double tolerance = 2e-10;          ///< error of one smooth-contact step [m]; less is more exact
  std::optional<Vec3> guide;         ///< unit vector: bodies move only along it and do not rotate
  CouplerGains obstacle_contact;     ///< K_vc, B_vc of spheres on obstacles
};

/// The bodies that must be right at the haptic rate, with the couplers and smooth contacts between
/// them. These are the haptic interface point, remote dynamic proxies and touched object copies.
///
/// Between events (contact made, contact broken, target set) linear motion is exact: a body alone
/// with its couplers, and everything in a guide. Other free bodies in contact are integrated
/// (Runge-Kutta 5(4), steps as long as IslandSettings::tolerance allows). Contacts made and broken
/// are located inside the step. Rigid contact is solved in inner steps, by sequential impulses.
/// State is `double`, in W. Deterministic to the bit. Not thread safe; the thread that ticks owns
/// the island. After prepare(), nothing allocates or throws until a body, coupler or contact is
/// added.
///
/// A free island (no guide) in which nothing moves falls asleep, and advance() does nothing.
/// Dynamic bodies must be slower than 1e-9 m/s and 1e-9 rad/s and accelerate by less than 1e-6
/// m/s^2 and rad/s^2. They must be within 5e-13 m of their rest position; a body without coupler
/// must stand still to rounding. Prescribed bodies must stand still. A call that changes a value
/// wakes the island before the next advance; setting the same value again does not.
class Island {
 public:
  /// Throws std::invalid_argument, naming the value, if a setting is out of range.
  explicit Island(const IslandSettings& settings);
  ~Island();
  Island(Island&&) noexcept;
  Island& operator=(Island&&) noexcept;

  /// @name Set-up: each may allocate, and throws std::invalid_argument that names the value.
  /// @{
  BodyIndex addBody(const IslandBody& body);
  CouplerIndex addCoupler(BodyIndex follower, const CouplerSettings& settings);
  /// Unilateral contact of a sphere body with any other body: eqs (7), (8), (11), (12). Does
  /// nothing for bodies of a guided island that pass each other on parallel lines.
  void addContact(BodyIndex sphere, BodyIndex other, const CouplerGains& gains);
  /// Adds room for a grip of a body that stands for a hand. It holds nothing at first. Not in a
  /// guided island.
  GripIndex addGrip(BodyIndex hand);
  /// Adds room for a body that comes and goes while the island runs, such as a neighbour of the
  /// host's world. The slot is inactive until filled. Spheres with `feels_obstacles` touch it like
  /// an obstacle (IslandSettings::obstacle_contact), and it receives the reaction force and torque.
  /// Not in a guided island.
  BodyIndex addSlot();
  /// False: contacts have no past. Those that begin deep push at once, and the nearest face pushes
  /// whatever was touched: a function of the state alone. Default true.
  void setTouchMemory(bool remembers) noexcept;
  /// Gives a body another filter for its smooth contacts.
  void setFilter(BodyIndex body, const CollisionFilter& filter);
  /// Sets the finder of rigid contacts; null: there are none. It must outlive the island.
  void setContactFinder(ContactFinder* finder);
  /// Sets the source of joints; null: there are none. It must outlive the island. Joints are not
  /// for a guided island. wake() after they have changed.
  void setJointSource(JointSource* joints);
  /// Builds the exact maps of everything added.
  void prepare();
  /// @}

  /// @name In the tick: real-time safe.
  /// @{
  /// A move that the velocities do not explain is a jump: contacts that it begins, or makes deeper,
  /// are let in gently (TouchMemory). The same holds for bodies and obstacles that come. A
  /// prescribed body never jumps.
  void setState(BodyIndex body, const RigidState& state) noexcept;
  /// Moves a body as something outside of the island has moved it, but into no rigid contact.
  void shift(BodyIndex body, const Vec3& offset_W, const Quat& rotation_W) noexcept;
  /// A prescribed body jumps with its next state: a device is back.
  void noteArrival(BodyIndex body) noexcept;
  void setTarget(CouplerIndex coupler, const RigidState& target) noexcept;
  /// External force and torque about the centre of mass, in W, until set again [N, N m]. An axis
  /// with factor 0 ignores them.
  void setExternalWrench(BodyIndex body, const Vec3& f_W, const Vec3& t_W) noexcept;
  /// Adds linear and angular momentum at once, whatever the factors: v += J / m, w += I^-1 L
  /// [N s, N m s].
  void applyImpulse(BodyIndex body, const Vec3& impulse_W, const Vec3& angular_W) noexcept;
  /// Joints answer the impulses since the last advance now; else they do in the next one.
  /// Velocities change, poses do not.
  void answerJoints() noexcept;
  /// Scales a coupler's original gains, linear and angular, by a share in 0 to 1, until set again.
  /// A share of 1 changes nothing, to the bit.
  void setCouplerShare(CouplerIndex coupler, double share) noexcept;
  /// Holds a body, or changes how it is held; null lets go. Once let go, hand and body may touch
  /// again: a deep contact is let in gently.
  void setGrip(GripIndex grip, const IslandGrip* hold) noexcept;
  /// Scales the gains of all smooth contacts of a body, beside IslandBody::contact_share.
  void setContactShare(BodyIndex body, double share) noexcept;
  /// Damping added to the body's own [N s/m], >= 0, until set again.
  void setExtraDamping(BodyIndex body, double damping) noexcept;
  /// Gives a dynamic body another mass [kg], > 0, principal moments [kg m^2] and own damping
  /// [N s/m]. It moves on at its velocities.
  void setMass(BodyIndex body, double mass, const Vec3& inertia_B, double damping) noexcept;
  /// A ghost stays where it is set, whatever the forces, and touches nothing. When it ends, the
  /// body moves on from there at the velocity that was set. Not for slots, prescribed bodies and
  /// bodies with rigid contacts.
  void setGhost(BodyIndex body, bool is_ghost) noexcept;
  /// Replaces the obstacles that spheres touch; the vector must live until the next call.
  void setObstacles(const std::vector<Obstacle>& obstacles) noexcept;
  /// Fills the slot with a body at its start state, without external forces, or replaces another
  /// body, which keeps its couplers and contacts. From the next advance it moves like any body. The
  /// body must satisfy addBody's checks (asserted, not thrown); `feels_obstacles` is ignored. Not
  /// in a guided island.
  void fill(BodyIndex slot, const IslandBody& body) noexcept;
  /// Empties the slot, or takes another body out until it is filled again: it moves nothing,
  /// touches nothing and costs nothing. Its state is RigidState{} until setState(). Not in a guided
  /// island.
  void clear(BodyIndex slot) noexcept;
  /// Ends sleep for a cause that the island cannot see: the ContactFinder's data changed.
  void wake() noexcept;
  /// Adds `offset_W` [m] to all positions. Nothing moves relative to anything, so no contact jumps.
  /// The owner does the same to its obstacles and contact finder.
  void shiftOrigin(const Vec3& offset_W) noexcept;
  /// Moves everything by `dt` [s], 0 < dt <= haptic_period.
  void advance(double dt) noexcept;
  /// Lets `dt` [s] pass for an owner that moves the bodies itself.
  void passTime(double dt) noexcept;
  /// A host step of `duration` [s] ends now, for takeContacts().
  void cutContacts(double duration) noexcept;
  /// Points of rigid contact in the host steps since the last call, for a host that wants to see
  /// them. Those between bodies that rest are reported once, and last. Valid until the next
  /// cutContacts().
  [[nodiscard]] const std::vector<ContactSum>& takeContacts() noexcept;
  /// True if no contact moves the body: it rests on something rigid, or forces move it never.
  [[nodiscard]] bool isStill(BodyIndex body) const noexcept;
  /// Moves the slots through the past `duration` [s], for bodies that enter with a state older than
  /// the island's. They touch each other, fixed surfaces and all other bodies. The other bodies
  /// move steadily from `from` to `to` and deviate where a slot pushes them. `asides` has their
  /// deviations so far and is updated. All vectors are by body index; the slots' own entries are
  /// unused. States, couplers and contacts of the other bodies stay unchanged.
  void catchUp(const std::vector<BodyIndex>& slots, const std::vector<RigidState>& from,
               const std::vector<RigidState>& to, double duration,
               std::vector<Aside>& asides) noexcept;
  /// @}

  /// Work done since prepare().
  [[nodiscard]] const IslandCounters& counters() const noexcept;
  /// Rises with each advance of an island that is awake. An island that sleeps at the same revision
  /// has slept all the time: states change only while it is awake.
  [[nodiscard]] std::uint64_t revision() const noexcept;

  /// True if the next advance has nothing to do.
  [[nodiscard]] bool isAsleep() const noexcept;
  /// Bodies that the next advance moves, in order: all except empty slots and bodies that sleep.
  /// Only these may have changed their state in the last advance.
  [[nodiscard]] const std::vector<BodyIndex>& awakeBodies() const noexcept;

  [[nodiscard]] const RigidState& state(BodyIndex body) const noexcept;
  /// Present target of a coupler: the last one set, or its follower's start before that.
  [[nodiscard]] const RigidState& target(CouplerIndex coupler) const noexcept;
  /// Number of bodies and slots.
  [[nodiscard]] int bodyCount() const noexcept;
  [[nodiscard]] bool isSlot(BodyIndex body) const noexcept;
  /// The body as added or filled.
  [[nodiscard]] const IslandBody& body(BodyIndex body) const noexcept;
  [[nodiscard]] int couplerCount() const noexcept;
  [[nodiscard]] BodyIndex follower(CouplerIndex coupler) const noexcept;
  [[nodiscard]] double couplerShare(CouplerIndex coupler) const noexcept;
  /// The settings as added, times the share.
  [[nodiscard]] const CouplerSettings& presentGains(CouplerIndex coupler) const noexcept;
  [[nodiscard]] double contactShare(BodyIndex body) const noexcept;
  /// The last external force set, without axes of factor 0; no torque if the body does not rotate.
  [[nodiscard]] const Vec3& externalForce(BodyIndex body) const noexcept;
  [[nodiscard]] const Vec3& externalTorque(BodyIndex body) const noexcept;
  [[nodiscard]] double extraDamping(BodyIndex body) const noexcept;
  [[nodiscard]] bool isGhost(BodyIndex body) const noexcept;
  [[nodiscard]] const std::vector<IslandContact>& contacts() const noexcept;
  /// The obstacles last set; null before.
  [[nodiscard]] const std::vector<Obstacle>* obstacles() const noexcept;
  /// True if forces move the body: it is dynamic, and neither an empty slot nor a ghost.
  [[nodiscard]] bool isDynamic(BodyIndex body) const noexcept;
  /// False for an empty slot.
  [[nodiscard]] bool isActive(BodyIndex body) const noexcept;

  /// Force and torque of a grip on its body at this instant; none if it holds nothing.
  [[nodiscard]] GripPull computeGripPull(GripIndex grip) const noexcept;
  /// Sum of the contact forces on a body at this instant, in W [N]. Grips count as contact.
  [[nodiscard]] Vec3 computeContactForce(BodyIndex body) const noexcept;
  /// Deepest overlap of a body in its smooth contacts, as if it were no ghost [m]; 0 if none. Other
  /// ghosts do not count. Real-time safe.
  [[nodiscard]] double computeOverlap(BodyIndex body) const noexcept;
  /// Deepest overlap of all spheres with faces that they touched, at the start of the last advance
  /// [m]; 0 if none. A sphere may have gone through a thin body: its face is that far away.
  [[nodiscard]] double deepestTouch() const noexcept;
  /// Force of a coupler on its follower at this instant, in W [N].
  [[nodiscard]] Vec3 computeCouplerForce(CouplerIndex coupler) const noexcept;
  /// Sum of all forces and torques on a dynamic body at this instant, with external ones and
  /// damping [N, N m].
  void computeWrench(BodyIndex body, Vec3& f_W, Vec3& t_W) const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
