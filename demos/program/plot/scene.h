#pragma once

#include <vector>

#include "plot/run.h"

namespace tandem::demos::plot {

/// Where a body is: its centre of mass [m] and its orientation, in the scene's frame.
struct Pose {
  Vec3 p = Vec3::Zero();
  Quat q = Quat::Identity();
};

/// The recorded motion of every body of a run, frame by frame.
struct SceneMotion {
  std::vector<double> times;             ///< of the frames [s]
  std::vector<std::vector<Pose>> poses;  ///< poses[body][frame]

  [[nodiscard]] std::size_t frames() const { return times.size(); }
};

/// Reads scene.csv of a run that has bodies. Throws UsageError naming file and line.
[[nodiscard]] SceneMotion loadScene(const Run& run);

/// As loadScene(), from a table that is already there.
[[nodiscard]] SceneMotion readScene(const Table& table, std::size_t bodies);

/// True when the body turns by more than a degree or so at any time.
[[nodiscard]] bool doesRotate(const std::vector<Pose>& poses);

/// Smallest axis-aligned box around something [m].
struct Bounds {
  Vec3 low = Vec3::Constant(1e300);
  Vec3 high = Vec3::Constant(-1e300);

  void include(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void include(const Bounds& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  [[nodiscard]] Vec3 size() const { return high - low; }
  [[nodiscard]] Vec3 centre() const { return 0.5 * (low + high); }
};

[[nodiscard]] Bounds boundsOf(const SceneBody& body, const Pose& pose);

/// What the moving bodies reach in the frames [begin, end).
[[nodiscard]] Bounds movingBounds(const Run& run, const SceneMotion& motion, std::size_t begin,
                                  std::size_t end);

/// What a picture of the scene should show: all that the moving bodies reach, and what stands still
/// near them. A floor or a wall that is much larger does not count.
[[nodiscard]] Bounds interestingBounds(const Run& run, const SceneMotion& motion);

/// Corner `index` (0 to 7; bits 0, 1, 2 choose +x, +y, +z) of a box in the scene's frame [m].
[[nodiscard]] Vec3 boxCorner(const SceneBody& body, const Pose& pose, int index);

/// Does this run show more than the paper's one axis: neighbours, obstacles or rotation?
[[nodiscard]] bool isSpatial(const Run& run, const SceneMotion& motion);

}  // namespace tandem::demos::plot
