#pragma once

#include <vector>

#include "gl/projection.h"
#include "replay/run_replay.h"

namespace tandem::view {

/// The eye itself if its picture shows all points, 5 % from its edges. Otherwise one that looks the
/// same way at their middle, from as near as shows them all, at most kFarthestEye away.
[[nodiscard]] Eye showAll(Eye eye, PictureSize size, const std::vector<Vec3>& points_W);

/// From where a recorded run is seen at first: as a live world, but hands and objects stay in the
/// picture.
[[nodiscard]] Eye chooseReplayEye(RunReplay& replay, PictureSize size);

}  // namespace tandem::view
