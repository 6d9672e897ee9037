#pragma once

#include <string>
#include <vector>

#include "bench/scenes/bench_scene.h"

/// \file
/// Parts that scenes are made of.
namespace tandem::demos::bench {

inline constexpr double kHalfCube = 0.02;    // [m]
inline constexpr double kToolRadius = 0.01;  // [m]
inline constexpr double kFriction = 0.3;
inline const Vec3 kGravity{0, 0, -9.81};  // [m/s^2]

/// A part of a device's path: `way` from time `start` on, at constant speed except `ease` at each
/// end.
struct Leg {
  double start = 0.0;       // [s]
  double time = 1.0;        // [s]
  Vec3 way = Vec3::Zero();  // [m]
  double ease = 0.05;       // part of `time` for acceleration, and for braking
};

/// A tool whose device moves one leg after another and stands still between them.
[[nodiscard]] BenchTool makeTool(const Vec3& start_W, std::vector<Leg> legs);

[[nodiscard]] BenchBody makeBox(std::string name, double mass, const Vec3& p_W,
                                const Vec3& half_extents = Vec3::Constant(kHalfCube));
/// The cube that the tool pushes. Its lower face is at height 0 if `z` is its half edge.
[[nodiscard]] BenchBody makeCube(double mass, double z = kHalfCube);
/// A wall whose near face is at `x`.
[[nodiscard]] BenchBody makeWall(double x);

[[nodiscard]] BenchScene makeScene(std::string name, std::string title, double duration);
/// A scene on the floor, with a tool that starts 2 mm left of the cube's left face.
[[nodiscard]] BenchScene makeFloorScene(std::string name, std::string title, double duration,
                                        double cube_mass, double tool_height,
                                        std::vector<Leg> legs);

/// Scenes of many or of very unequal bodies.
[[nodiscard]] std::vector<BenchScene> makePiles();
/// Scenes of bodies in joints.
[[nodiscard]] std::vector<BenchScene> makeJoined();

}  // namespace tandem::demos::bench
