#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tandem/coordination/types.h"

namespace tandem::demos {

/// Most bodies of a scenario, and most joints.
inline constexpr std::size_t kMostBodies = 500;

/// Form of a body or of one of its parts, about its own origin. Lengths in m. Round forms stand
/// along z. What the form does not need is empty.
struct ShapeScenario {
  std::string kind = "box";                   ///< box, sphere, capsule, cylinder, cone, hull, mesh
  std::optional<Vec3> size;                   ///< edges of a box
  std::optional<double> radius, height;       ///< a capsule's height is that between its half balls
  std::vector<std::array<double, 3>> points;  ///< of a hull, or corners of a mesh
  std::vector<std::array<int, 3>> triangles;  ///< of a mesh: numbers of points, from 0
  /// OBJ file of a hull or mesh, relative to the scenario. loadScenario() reads it into the two
  /// above, and leaves this empty.
  std::string file;
};

/// A form at its place in a body.
struct PartScenario {
  ShapeScenario shape;
  Vec3 position = Vec3::Zero();  ///< [m]
  Vec3 rotation = Vec3::Zero();  ///< axis times angle [rad]
};

/// A body of both sites' worlds, in the scene's frame.
struct BodyScenario {
  std::string name;  ///< one of its kind, as the names of shared bodies are
  ShapeScenario shape;
  std::vector<PartScenario> parts;  ///< in place of one shape
  double mass = 0.0;                ///< [kg]; 0: static
  std::optional<Vec3> inertia;      ///< about its own axes [kg m^2]; empty: that of its shape
  Vec3 position = Vec3::Zero();     ///< of its centre of mass [m]
  Vec3 rotation = Vec3::Zero();     ///< axis times angle [rad]
  std::optional<double> friction;   ///< empty: that of the world
  double restitution = 0.0;
  double damping = 0.0;  ///< of a shared body's copies [N s/m]
  bool shared = false;
  int tool_of = 0;     ///< user (from 1) whose hand holds it always; 0: nobody's tool
  std::string colour;  ///< "#rrggbb"; empty: that of its role
};

/// A joint between two bodies, or between a body and the world.
struct JointScenario {
  std::string kind = "hinge";                   ///< hinge, slider, ball, weld
  std::vector<std::string> bodies;              ///< one or two names
  Vec3 at = Vec3::Zero();                       ///< in the scene's frame [m]
  Vec3 axis = Vec3::UnitZ();                    ///< of a hinge or slider, in the scene's frame
  std::optional<std::array<double, 2>> limits;  ///< of a hinge [rad] or slider [m]
  double friction = 0.0;                        ///< of a hinge [N m] or slider [N]
};

/// A picture is seen from here, in the scene's frame.
struct CameraScenario {
  Vec3 target = Vec3::Zero();  ///< [m]
  double distance = 0.0;       ///< [m]; 0: from behind user 1, near enough for all that is shared
  double azimuth = -1.9;       ///< of the eye about z, from x [rad]
  double elevation = 0.6;      ///< [rad]
};

}  // namespace tandem::demos
