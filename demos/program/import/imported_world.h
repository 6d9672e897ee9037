#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenario/body_scenario.h"

namespace tandem::demos {

/// Bodies and joints of a file of another format, as a scenario would have them.
struct ImportedWorld {
  std::vector<BodyScenario> bodies;
  std::vector<JointScenario> joints;
  /// The file's own names, with the body that each has become. Bodies that the file welds together
  /// are one.
  std::map<std::string, std::string> names;
};

/// Reads URDF or MJCF. Throws UsageError with what is wrong in the file, or that the program is
/// built without MuJoCo, which reads both.
[[nodiscard]] ImportedWorld importMujoco(const std::filesystem::path& file);

/// Reads a .bullet file. `host_step` [s] turns a motor's impulse into a joint's friction. Throws
/// UsageError with what is wrong in the file, or that the program is built without the reader.
[[nodiscard]] ImportedWorld importBullet(const std::filesystem::path& file, double host_step);

}  // namespace tandem::demos
