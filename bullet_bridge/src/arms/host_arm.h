#pragma once

#include <array>
#include <memory>
#include <vector>

#include <LinearMath/btAlignedObjectArray.h>
#include <LinearMath/btMatrix3x3.h>
#include <LinearMath/btQuaternion.h>

#include "arms/arm_model.h"
#include "arms/arm_watch.h"
#include "arms/link_body.h"

class btMultiBody;
class btDiscreteDynamicsWorld;

#pragma GCC visibility push(default)
namespace tandem {

// clang-format off
/// A multi-body of the host's world whose motion the island decides: its links are bodies of the
/// island, which joints hold together (ArmJoints).
///
///   pre-tick    look      what the host did to joints, base and links
///               handOff   joint velocities that lead to the island's poses; forces that cancel what
///                         Bullet's forward dynamics is about to add
///   post-tick   restore   what Bullet's solver gave beside that, as momentum and moves of the links;
///                         joint positions and velocities := the island's
///               place     the same with what the island made of it
///
/// Bullet keeps its forces and its limit of velocities in between. The multi-body stays awake. Once
/// it has left its world it is neither read nor written. All functions except the constructor are
/// real-time safe, and for the thread that steps the world.
// clang-format on
class HostArm {
 public:
  /// The multi-body must be in the world, and one that the island can hold.
  HostArm(btDiscreteDynamicsWorld& world, btMultiBody& body);
  ~HostArm();
  HostArm(const HostArm&) = delete;
  HostArm& operator=(const HostArm&) = delete;

  [[nodiscard]] btMultiBody& body() const noexcept { return body_; }
  [[nodiscard]] const ArmModel& model() const noexcept { return model_; }
  /// The island's bodies, from the base outwards.
  [[nodiscard]] const std::vector<std::unique_ptr<LinkBody>>& links() const noexcept {
    return links_;
  }
  [[nodiscard]] bool isInWorld() const noexcept { return hasMultiBody(world_, &body_); }
  /// False once the host has made it another one, or one that the island cannot hold. It must be in
  /// its world.
  [[nodiscard]] bool isAsHeld() const noexcept {
    return look_.isOf(body_) && !findObstacleToHold(*asMultiBodyWorld(world_), body_);
  }

  void look(double dt) noexcept;
  void handOff(double dt) noexcept;
  void restore() noexcept;
  void place() noexcept;
  void remember() noexcept;

  [[nodiscard]] RigidState findState(std::size_t place) const noexcept;
  /// Bullet's present states of base and links, by place.
  void findStates(std::vector<RigidState>& states) const noexcept;
  [[nodiscard]] Vec3 worldGravity() const noexcept;
  /// Bullet's damping at low speeds: the velocity that it takes off per second [1/s].
  void readDamping(double& linear, double& angular) const noexcept;
  /// Pre-tick, after handOff(). Velocity with which a joint goes through Bullet's step along one
  /// of its degrees of freedom [rad/s or m/s].
  [[nodiscard]] double expectedVelocity(std::size_t place, std::size_t dof = 0) const noexcept {
    return static_cast<double>(expected_[6 + findDof(place) + dof]);
  }
  /// Mass, or moment of inertia, that a joint moves along one of its degrees of freedom, as of the
  /// last handOff() [kg or kg m^2].
  [[nodiscard]] double findMass(std::size_t place, std::size_t dof = 0) const noexcept;
  /// Degrees of freedom: of a base that moves, turns first, and of the joints.
  [[nodiscard]] std::size_t countFree() const noexcept {
    return static_cast<std::size_t>(mobility_.rows());
  }
  /// Velocity of one of them by a unit impulse along another, as of the last handOff().
  [[nodiscard]] double mobility(std::size_t one, std::size_t other) const noexcept {
    return mobility_(static_cast<Eigen::Index>(one), static_cast<Eigen::Index>(other));
  }

 private:
  friend class LinkBody;

  /// Number of a link's first degree of freedom among those of all joints.
  [[nodiscard]] std::size_t findDof(std::size_t place) const noexcept;
  void wake() noexcept;
  void noteForces(double dt) noexcept;
  void addDrag(LinkBody& link, const RigidState& state, double dt) const noexcept;
  void takeEnds(ArmCoordinates& into, double dt = 0.0) noexcept;
  void readMobility() noexcept;
  void addMomenta(ArmCoordinates& to) noexcept;
  void cancelAccelerations(double dt) noexcept;
  void computeAccelerations() noexcept;
  [[gnu::visibility("hidden")]] void readVelocities(std::vector<btScalar>& into) const noexcept;
  void setVelocities(ArmCoordinates& into) const noexcept;
  void applyMomenta(const std::vector<RigidState>& links, ArmCoordinates& to) noexcept;
  void factorise() noexcept;
  void giveForcesBack() noexcept;
  void putLinks() noexcept;
  void findSolverChange() noexcept;
  void show(const ArmCoordinates& coordinates) noexcept;
  void addMomentum(std::size_t place, const Momentum& momentum) noexcept;
  void shiftOrigin(const Vec3& offset_W) noexcept;

  btDiscreteDynamicsWorld& world_;
  btMultiBody& body_;
  ArmModel model_;
  ArmLook look_;
  std::vector<std::unique_ptr<LinkBody>> links_;
  std::size_t dofs_;                          ///< of the joints
  bool has_no_weight_;                        ///< it slept when Bullet gave weight
  bool is_handed_ = false;                    ///< between handOff() and restore()
  bool has_place_ = false, has_put_ = false;  ///< links have states that Bullet has not yet
  btScalar most_velocity_ = 0;

  ArmCoordinates known_;  ///< as left to the host
  ArmCoordinates start_, end_, mean_;
  mutable ArmCoordinates now_;              ///< working memory
  mutable std::vector<RigidState> states_;  ///< working memory, by place
  std::vector<RigidState> known_states_, start_states_;
  std::vector<Momentum> momenta_;
  std::vector<std::array<double, 3>> impulses_;
  std::vector<btScalar> expected_;    ///< velocities after the step if nothing else acts
  std::vector<btScalar> velocities_;  ///< working memory
  std::vector<btScalar> accelerations_, unit_, response_;
  Eigen::MatrixXd mobility_;  ///< velocities by generalised impulses
  Eigen::VectorXd load_;
  Eigen::LDLT<Eigen::MatrixXd> solver_;
  std::vector<std::array<btScalar, 3>> host_torques_;  ///< of joints, by place
  std::array<btScalar, 6> host_base_{};                ///< torque and force on the base
  btAlignedObjectArray<btScalar> scratch_r_;
  btAlignedObjectArray<btVector3> scratch_v_;
  btAlignedObjectArray<btMatrix3x3> scratch_m_;
  btAlignedObjectArray<btQuaternion> turns_;
  btAlignedObjectArray<btVector3> origins_;
};

}  // namespace tandem
#pragma GCC visibility pop
