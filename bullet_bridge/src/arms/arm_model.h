#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "tandem/coordination/types.h"

#include "bodies/momentum.h"

class btMultiBody;

#pragma GCC visibility push(default)
namespace tandem {

/// How a link of a multi-body moves relative to its parent.
enum class LinkKind { kFixed, kRevolute, kPrismatic, kSpherical, kPlanar };

/// The role of a link in the island.
enum class LinkRole {
  kBody,    ///< a body of the island
  kFrame,   ///< fixed to its parent, without mass: a part of the parent's body
  kGround,  ///< never moves: a fixed base, and what is fixed to it
};

/// A link of a multi-body. Place 0 is the base, place i + 1 Bullet's link i. Frames of links have
/// their origin at the centre of mass and axes along the principal ones.
struct ArmLink {
  LinkRole role = LinkRole::kBody;
  LinkKind kind = LinkKind::kFixed;
  std::size_t parent = 0;  ///< its place
  double mass = 0.0;
  Vec3 inertia = Vec3::Zero();
  Vec3 d = Vec3::Zero();            ///< from the joint to the centre of mass, in the link [m]
  Vec3 e = Vec3::Zero();            ///< from the parent's centre of mass to the joint, in it [m]
  Quat q_PZ = Quat::Identity();     ///< orientation in the parent while the joint is at zero
  std::size_t dofs = 0;             ///< degrees of freedom
  std::array<Vec3, 3> turn, slide;  ///< angular and linear velocity per joint velocity, in the link
};

/// Positions and velocities of a multi-body's joints and base, as Bullet counts them.
struct ArmCoordinates {
  struct Joint {
    std::array<double, 4> q{};  ///< [rad, m]; spherical: a quaternion x y z w; planar: angle, ways
    std::array<double, 3> u{};  ///< [rad/s, m/s]; spherical: in the link; planar: in the link, too
    [[nodiscard]] bool operator==(const Joint&) const noexcept = default;
  };
  RigidState base;
  std::vector<Joint> joints;  ///< by place; the base's is unused
};

/// A multi-body's tree and its kinematics, in double. Plain values, without any of Bullet's.
class ArmModel {
 public:
  /// Reads a multi-body whose joints are all of known types. Allocates.
  explicit ArmModel(const btMultiBody& body);

  [[nodiscard]] const std::vector<ArmLink>& links() const noexcept { return links_; }
  [[nodiscard]] std::size_t size() const noexcept { return links_.size(); }
  [[nodiscard]] bool isBaseFixed() const noexcept { return links_[0].role == LinkRole::kGround; }
  /// Place of the body, or piece of ground, that a link is a part of.
  [[nodiscard]] std::size_t carrier(std::size_t place) const noexcept;
  [[nodiscard]] std::size_t countBodies() const noexcept;

  /// Reads the present coordinates. Real-time safe if `into` has been filled before, as all below.
  static void read(const btMultiBody& body, ArmCoordinates& into);
  /// Sets the multi-body's coordinates; those of a fixed base stay.
  void write(const ArmCoordinates& from, btMultiBody& body) const noexcept;

  /// States of all links.
  void findLinks(const ArmCoordinates& from, std::vector<RigidState>& links) const noexcept;
  /// Coordinates by the states of all bodies; `links` gets those of frames and ground. Whole turns
  /// are those nearest to where `into` leads in a time of `dt` [s], with its and the new
  /// velocities.
  void findCoordinates(std::vector<RigidState>& links, ArmCoordinates& into,
                       double dt = 0.0) const noexcept;
  /// Velocities that lead from one pose to another in a step of dt [s], by Bullet's own step.
  void findMeanVelocity(const ArmCoordinates& start, const ArmCoordinates& end, double dt,
                        ArmCoordinates& mean) const noexcept;
  /// Impulses along all joints by momentum given to links at poses `links`. `momenta` is by place,
  /// and gets the sums over what hangs on each link; that of the base remains for the base.
  void findJointImpulses(const std::vector<RigidState>& links, std::vector<Momentum>& momenta,
                         std::vector<std::array<double, 3>>& impulses) const noexcept;

 private:
  void findLink(std::size_t place, const ArmCoordinates& from,
                std::vector<RigidState>& links) const noexcept;

  std::vector<ArmLink> links_;
};

}  // namespace tandem
#pragma GCC visibility pop
