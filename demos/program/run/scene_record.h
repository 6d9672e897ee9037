#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "world/scene.h"

namespace tandem::demos {

/// Poses of all bodies at one moment, in the scene's frame, for pictures.
struct SceneFrameRecord {
  double time = 0.0;
  std::vector<RigidState> poses;  ///< ordered as in SceneRecord::bodies()
};

/// A body of a picture, and its site, from 1.
struct PlacedSceneBody {
  int site = 1;
  SceneBody body;
};

/// Poses of all bodies of one site or several, about 30 times a second. For the thread that steps
/// the worlds.
class SceneRecord {
 public:
  static constexpr double kRate = 30.0;  ///< pictures for each second [Hz]

  /// Keeps pictures of the first `duration` seconds, for which it reserves memory.
  SceneRecord(const SceneFrame& frame, double duration);

  /// Adds the world of a site, from 1, which must outlive the last keep(). Before the first
  /// picture.
  void add(int site, SiteWorld& world);

  /// True if it is time for the next picture at `time` [s], and there is room for it. A world that
  /// stands still gives no second one.
  [[nodiscard]] bool isDue(double time) const noexcept;
  /// Keeps a picture of now. Allocates. Haptic threads may run.
  void keep(double time);

  [[nodiscard]] const std::vector<PlacedSceneBody>& bodies() const noexcept { return bodies_; }
  [[nodiscard]] const std::vector<SceneFrameRecord>& frames() const noexcept { return frames_; }

  /// The list `scene.bodies` of a summary.
  [[nodiscard]] nlohmann::json describeBodies() const;
  /// Writes a table such as scene.csv. Throws Error with the file's name.
  void writeCsv(const std::filesystem::path& file) const;

 private:
  SceneFrame frame_;
  std::size_t most_;
  std::vector<SiteWorld*> worlds_;
  std::vector<PlacedSceneBody> bodies_;
  std::vector<SceneFrameRecord> frames_;
};

}  // namespace tandem::demos
