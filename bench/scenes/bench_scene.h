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
/// read. World frame W, z up, SI units. All motion is in the x-z plane or has no plane at all, so
/// that planar solvers can be compared with spatial ones.
namespace tandem::demos::bench {

/// Targets of couplers are sampled and held at this rate [Hz], for every method and the reference.
inline constexpr int kTargetRate = 1000;
/// Times at which states are compared are whole numbers of 1/kGridRate s: a common multiple of all
/// host rates and of kTargetRate [Hz].
inline constexpr int kGridRate = 12000;

struct BoxShape {
  Vec3 half_extents = Vec3::Constant(0.02);  ///< [m]
};
struct SphereShape {
  double radius = 0.02;  ///< [m]
};
/// Everything on the side of p_WB where (p - p_WB) . normal_W < 0; static.
struct PlaneShape {
  Vec3 normal_W = Vec3::UnitZ();
};

/// A body that tools touch and that touches other bodies rigidly: restitution 0, friction
/// BenchScene::friction, no damping, uniform density.
struct BenchBody {
  std::string name;
  std::variant<BoxShape, SphereShape, PlaneShape> shape = BoxShape{};
  double mass = 0.0;       ///< [kg]; 0: static
  bool is_shared = false;  ///< the plugin shares it; elsewhere a body like any other
  RigidState start;

  [[nodiscard]] bool isStatic() const { return mass == 0.0; }
};

/// A sphere that a user holds by a spring-damper, as the plugin holds a remote dynamic proxy. It
/// does not turn, feels no gravity, and touches bodies by the scene's compliant contact only: force
/// max(0, K overlap + B overlap') along the normal, no friction. Tools do not touch each other.
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
  std::string title;                   ///< for readers
  double duration = 1.0;               ///< [s]
  Vec3 gravity_W = Vec3::Zero();       ///< on bodies, not on tools [m/s^2]
  double friction = 0.0;               ///< Coulomb coefficient of every pair of bodies
  CouplerGains coupler{2000.0, 10.0};  ///< tool to its device [N/m, N s/m]
  CouplerGains contact{2000.0, 10.0};  ///< tool to bodies, in total per touching pair
  std::vector<BenchTool> tools;
  std::vector<BenchBody> bodies;

  /// Every contact that acts is a compliant one, and no body turns: the reference is then the
  /// event-located one, else the fine-stepped planar one.
  bool is_smooth = false;
};

/// What a tool is tied to at time `t` [s]: its device's state at the last multiple of
/// 1/kTargetRate, held. Nothing without a coupler.
[[nodiscard]] std::optional<PointState> heldTarget(const BenchTool& tool, double t);

/// Principal moments of a body of uniform density, in B [kg m^2]; zero if it is static.
[[nodiscard]] Vec3 computeInertia(const BenchBody& body);

/// All scenes, in the order of tables and figures.
[[nodiscard]] const std::vector<BenchScene>& allScenes();

/// States of all moving things at one moment, in the order of BenchScene::tools and ::bodies.
struct SceneState {
  std::vector<PointState> tools;
  std::vector<RigidState> bodies;  ///< static ones stay at their start
};

[[nodiscard]] SceneState startState(const BenchScene& scene);

}  // namespace tandem::demos::bench
