#pragma once

#include <string>
#include <vector>

#include "tandem/coordination/types.h"

namespace tandem::falcon_detail {

/// One row of a recorded force.
struct ForceRow {
  double t = 0.0;           ///< [s]
  Vec3 f_W = Vec3::Zero();  ///< [N]
};

/// Reads a recorded force, header `t,force_x,force_y,force_z`: one or more rows, all finite, times
/// growing. Throws tandem::Error "FILE:LINE: what is wrong; remedy", one line of text.
[[nodiscard]] std::vector<ForceRow> readForceRecording(const std::string& csv_path);

}  // namespace tandem::falcon_detail
