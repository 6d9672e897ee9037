#include "novint/falcon_edge.h"

#include <algorithm>

namespace tandem {

double computeEdgeShare(const FalconKinematics& kinematics, const FalconPose& pose,
                        const Vec3& torques, double way, double most) noexcept {
  const auto feel = [&](const FalconPose& at) -> double {
    return (at.dangles_dp.transpose() * torques).norm();
  };
  double largest = feel(pose);
  for (Eigen::Index leg = 0; leg < 3; ++leg) {
    // The way on which this leg stretches most, or folds most.
    const Vec3 outward = pose.dangles_dp.row(leg).normalized();
    for (const double step : {way, -way}) {
      const auto there = kinematics.computePose(Vec3(pose.p_D + step * outward));
      if (!there) return 0.0;
      largest = std::max(largest, feel(*there));
    }
  }
  return largest <= most ? 1.0 : most / largest;
}

}  // namespace tandem
