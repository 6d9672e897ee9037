#include "device/user_axes.h"

namespace tandem::demos {

Quat computeUserAxes(const Quat& q_WS, int site) {
  const Vec3 ahead_S = site % 2 == 0 ? Vec3(1, 0, 0) : Vec3(-1, 0, 0), up_S(0, 0, 1);
  Eigen::Matrix3d r_SD;
  r_SD << ahead_S.cross(up_S), up_S, -ahead_S;
  return (q_WS * Quat(r_SD)).normalized();
}

}  // namespace tandem::demos
