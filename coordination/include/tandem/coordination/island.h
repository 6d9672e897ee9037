#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "tandem/coordination/rigid_contacts.h"
#include "tandem/coordination/shape.h"
#include "tandem/coordination/virtual_coupler.h"

namespace tandem {

/// Index of a coupler in its island, in the order in which couplers were added.
using CouplerIndex = int;

/// How a body of the island moves.
enum class Motion {
  kDynamic,     ///< by the forces on it
  kPrescribed,  ///< p + v tau from the state last set: the local haptic interface point inside a
                ///< tick
  kHeld,  ///< stays at the position last set while its velocity counts in dampers: a received state
};

/// A body of the island. Plain value; checked by Island::addBody.
struct IslandBody {
  Shape shape = Sphere{0.01};
  Motion motion = Motion::kDynamic;
  double mass = 0.0;              ///< [kg], > 0 if dynamic
  Vec3 inertia_B = Vec3::Zero();  ///< principal moments [kg m^2]; zero: no turning about that axis
  double damping = 0.0;           ///< force against the velocity, b [N s/m], >= 0
  bool feels_obstacles = false;   ///< a sphere that touches obstacles through Island::setObstacles
  bool is_rigid = false;          ///< held by RigidContacts (floor, walls) in addition
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

struct IslandSettings {
  double haptic_period = 1e-3;       ///< [s]; the exact maps are built for it and its binary parts
  double inner_step = 1.0 / 4000.0;  ///< step where motion is not linear [s]; smaller is more exact
  std::optional<Vec3> guide;         ///< unit vector: bodies keep only this direction, no rotation
  CouplerGains obstacle_contact;     ///< K_vc, B_vc of spheres on obstacles
};

/// The small set of bodies that must be right at the haptic rate: haptic interface point, remote
/// dynamic proxies, touched object copies; with the couplers and smooth contacts between them.
///
/// Motion is exact between events (contact made, contact broken, target set) wherever it is linear:
/// a body alone with its couplers, and everything in a guide. Elsewhere - free bodies in touch - it
/// is integrated by Runge-Kutta 4 with contacts made and broken located inside the step. Rigid
/// contact is RigidContacts'. State is `double`, in W. Deterministic to the bit. Not thread safe;
/// whoever ticks owns the island. After prepare(), nothing allocates or throws until a body,
/// coupler or contact is added.
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
  /// Who solves rigid contact; may be null. Must outlive the island.
  void setRigidContacts(RigidContacts* rigid);
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
  /// Replaces the obstacles that spheres touch; the vector must live until the next call.
  void setObstacles(const std::vector<Obstacle>& obstacles) noexcept;
  /// Moves everything by `dt` [s], 0 < dt <= haptic_period.
  void advance(double dt) noexcept;
  /// @}

  [[nodiscard]] const RigidState& state(BodyIndex body) const noexcept;
  [[nodiscard]] int bodyCount() const noexcept;
  /// True if forces move it.
  [[nodiscard]] bool isDynamic(BodyIndex body) const noexcept;

  /// Sum of the contact forces on a body at this instant, in W [N].
  [[nodiscard]] Vec3 computeContactForce(BodyIndex body) const noexcept;
  /// Force of a coupler on its follower at this instant, in W [N].
  [[nodiscard]] Vec3 computeCouplerForce(CouplerIndex coupler) const noexcept;
  /// All forces and torques on a dynamic body at this instant, external and damping included [N, N
  /// m].
  void computeWrench(BodyIndex body, Vec3& f_W, Vec3& t_W) const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
