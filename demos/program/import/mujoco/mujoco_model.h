#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <mujoco/mujoco.h>

namespace tandem::demos {

struct FreeMujoco {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};

/// A model as MuJoCo compiles it, with all its poses in the start.
struct MujocoModel {
  std::unique_ptr<mjModel, FreeMujoco> model;
  std::unique_ptr<mjData, FreeMujoco> start;
};

/// Compiles URDF or MJCF, with the files that it names; `text` is what `file` holds. Links of URDF
/// keep their names, and their colours where their visual parts can be read. Throws UsageError with
/// MuJoCo's own line.
[[nodiscard]] MujocoModel loadMujoco(const std::filesystem::path& file, const std::string& text);

}  // namespace tandem::demos
