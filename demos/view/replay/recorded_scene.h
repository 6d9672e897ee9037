#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tandem/coordination/types.h"

namespace tandem::view {

/// A body of a recorded scene, as summary.json lists it.
struct RecordedBody {
  int site = 0;  ///< counted from 0
  std::string name;
};

/// Where a body is, in the scene's frame.
struct RecordedPose {
  Vec3 p_S = Vec3::Zero();  ///< [m]
  Quat q_SB = Quat::Identity();
};

/// Poses of all bodies of one site, frame by frame.
struct RecordedScene {
  std::vector<std::string> names;   ///< of the bodies
  std::vector<double> times;        ///< of the frames, growing [s]
  std::vector<RecordedPose> poses;  ///< of all bodies in the first frame, then in the next
};

/// Reads the scenes of `sites` sites from a table such as scene.csv, in which each frame has all
/// `bodies` in their order. Throws UsageError with file, line and remedy.
[[nodiscard]] std::vector<RecordedScene> readRecordedScenes(const std::filesystem::path& file,
                                                            const std::vector<RecordedBody>& bodies,
                                                            std::size_t sites);

/// Pose of a body at a time, straight between two frames; before the first and after the last frame
/// as there.
[[nodiscard]] RecordedPose computePose(const RecordedScene& scene, std::size_t body, double time);

}  // namespace tandem::view
