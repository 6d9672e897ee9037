#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tandem/coordination/types.h"

#include "coordination/src/island/virtual_coupler.h"

/// \file
/// The scenes of `tandem bench accuracy`: each is one value that every method and the reference
/// read. World frame W, z up, SI units. All motion is in the x-z plane or in no particular plane.
/// So planar solvers can be compared with spatial ones.
namespace tandem::demos::bench {

/// Every method and the reference sample and hold the couplers' targets at this rate [Hz].
inline constexpr int kTargetRate = 1000;
/// States are compared at whole multiples of 1/kGridRate s. This is a common multiple of all host
/// rates and of kTargetRate [Hz].
inline constexpr int kGridRate = 12000;

struct BoxShape {
  Vec3 half_extents = Vec3::Constant(0.02);  ///< [m]
};
struct SphereShape {
  double radius = 0.02;  ///< [m]
};
/// A static half-space: all points with (p - p_WB) . normal_W < 0.
struct PlaneShape {
  Vec3 normal_W = Vec3::UnitZ();
};

/// A body that tools touch, and that touches other bodies rigidly. Restitution is 0, friction is
/// BenchScene::friction, there is no damping, and density is uniform.
struct BenchBody {
  std::string name;
  std::variant<BoxShape, SphereShape, PlaneShape> shape = BoxShape{};
  double mass = 0.0;       ///< [kg]; 0: static, or a belt that moves at its start's v_W for ever
  bool is_shared = false;  ///< the plugin shares it; for other methods a normal body
  RigidState start;

  [[nodiscard]] bool isStatic() const { return mass == 0.0; }
  [[nodiscard]] bool isBelt() const { return isStatic() && start.v_W != Vec3::Zero(); }
};

enum class BenchJointKind { kHinge, kSlider };

/// An ideal joint that leaves body `a` one coordinate against body `b`, or against the world: its
/// turn about y [rad], or its way along an axis [m]. Coordinates are 0 at the start. Joined bodies
/// do not touch each other. A limit has restitution 0.
struct BenchJoint {
  struct Limit {
    double low = 0.0, high = 0.0;  ///< [rad or m]
  };
  struct Motor {
    double speed = 0.0;  ///< wanted rate of the coordinate [rad/s or m/s]
    double force = 0.0;  ///< the most that it gives [N m or N]
  };

  BenchJointKind kind = BenchJointKind::kHinge;
  std::size_t a = 0;             ///< index of a body that moves
  std::optional<std::size_t> b;  ///< index of another body; none: the world
  Vec3 pivot_W = Vec3::Zero();   ///< where the joint is at the start [m]
  Vec3 axis_W = Vec3::UnitX();   ///< way of a slider at the start, of length 1
  std::optional<Limit> limit;
  std::optional<Motor> motor;
};

/// A sphere that a user holds by a spring-damper, like the plugin's remote dynamic proxy. It does
/// not rotate, feels no gravity, and touches bodies by the scene's compliant contact only. Its
/// contact force is max(0, K overlap + B overlap') along the normal, without friction. Tools do not
/// touch each other.
struct BenchTool {
  double radius = 0.01;  ///< [m]
  double mass = 0.1;     ///< [kg]
  PointState start;
  Vec3 f_W = Vec3::Zero();  ///< constant external force [N]
  /// The user's device: position and velocity at time t; continuous in position. Null: no coupler.
  std::function<PointState(double t)> device;
};

struct BenchScene {
  std::string name;                    ///< identifier, for files and options
  std::string title;                   ///< title in tables and figures
  double duration = 1.0;               ///< [s]
  Vec3 gravity_W = Vec3::Zero();       ///< acts on bodies, not on tools [m/s^2]
  double friction = 0.0;               ///< Coulomb coefficient of every pair of bodies
  CouplerGains coupler{2000.0, 10.0};  ///< tool to its device [N/m, N s/m]
  CouplerGains contact{2000.0, 10.0};  ///< tool to bodies, in total per touching pair
  std::vector<BenchTool> tools;
  std::vector<BenchBody> bodies;
  std::vector<BenchJoint> joints;

  /// Every active contact is compliant, and no body rotates. The reference is then the
  /// event-located one, else the fine-stepped planar one.
  bool is_smooth = false;
};

/// Target of a tool's coupler at time `t` [s]: its device's state at the last multiple of
/// 1/kTargetRate, held. Empty without a coupler.
[[nodiscard]] std::optional<PointState> heldTarget(const BenchTool& tool, double t);

/// Principal moments of a body of uniform density, in B [kg m^2]; zero if it is static.
[[nodiscard]] Vec3 computeInertia(const BenchBody& body);

/// All scenes, in the order of tables and figures.
[[nodiscard]] const std::vector<BenchScene>& allScenes();

/// States of all moving bodies at one moment, in the order of BenchScene::tools and ::bodies.
struct SceneState {
  std::vector<PointState> tools;
  std::vector<RigidState> bodies;  ///< without mass: unspecified
};

[[nodiscard]] SceneState startState(const BenchScene& scene);

}  // namespace tandem::demos::bench
