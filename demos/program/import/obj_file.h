#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "tandem/coordination/types.h"

namespace tandem::demos {

/// Surface from an OBJ file.
struct ObjFile {
  std::vector<Vec3> points;                           ///< [m]
  std::vector<std::array<std::size_t, 3>> triangles;  ///< corners, counter-clockwise from outside
};

/// Reads all triangles of all objects of a file; faces of more corners are cut into triangles.
/// Throws UsageError, one line, for a file that is none, has no face, or names corners that it
/// does not have.
[[nodiscard]] ObjFile readObj(const std::filesystem::path& path);

}  // namespace tandem::demos
