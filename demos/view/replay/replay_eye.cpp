#include "replay/replay_eye.h"

#include <algorithm>

#include "gl/eye_motion.h"
#include "session/first_eye.h"

namespace tandem::view {
namespace {

constexpr double kEdge = 0.05;  // of the picture's width and height
constexpr double kStepBack = 1.05;

bool shows(const Eye& eye, PictureSize size, const Vec3& p_W) {
  const auto seen = projectPoint(eye, size, p_W);
  const auto isInside = [](double at, int length) {
    return at >= kEdge * length && at <= (1.0 - kEdge) * length;
  };
  return seen && isInside(seen->point.x, size.width) && isInside(seen->point.y, size.height);
}

bool showsAll(const Eye& eye, PictureSize size, const std::vector<Vec3>& points_W) {
  return std::ranges::all_of(points_W, [&](const Vec3& p_W) { return shows(eye, size, p_W); });
}

}  // namespace

Eye showAll(Eye eye, PictureSize size, const std::vector<Vec3>& points_W) {
  if (showsAll(eye, size, points_W)) return eye;
  Vec3 low_W = points_W.front(), high_W = points_W.front();
  for (const Vec3& p_W : points_W) {
    low_W = low_W.cwiseMin(p_W);
    high_W = high_W.cwiseMax(p_W);
  }
  eye.target_W = 0.5 * (low_W + high_W);
  while (eye.distance < kFarthestEye && !showsAll(eye, size, points_W)) eye.distance *= kStepBack;
  return limitEye(eye);
}

Eye chooseReplayEye(RunReplay& replay, PictureSize size) {
  return showAll(chooseFirstEye(replay.scenario(), replay.user()), size, replay.findWays());
}

}  // namespace tandem::view
