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

/// Reads a recorded force with the header `t,force_x,force_y,force_z`. It needs one or more rows,
/// finite values, growing times and forces of at most 1e6 N. Throws tandem::Error
/// "FILE:LINE: fault; remedy" in one line.
[[nodiscard]] std::vector<ForceRow> readForceRecording(const std::string& csv_path);

}  // namespace tandem::falcon_detail
