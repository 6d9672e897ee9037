#include "velocity_wall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "support/random.h"

namespace tandem::bench {
namespace {

constexpr double kPeriod = 1e-3;          // [s]
constexpr int kSubsteps = 20;             // sub-steps of the handle's motion in a period
constexpr int kTicks = 1500, kEnd = 500;  // all ticks; the last ones are measured
constexpr int kPlaces = 10;               // places in the middle of the workspace
constexpr double kMass = 0.15;            // [kg]
constexpr double kOwnDamping = 0.5;       // [N s/m]
constexpr double kPress = 3.0;            // [N]
constexpr double kCalm = 1e-4;            // [m]
constexpr double kAway = 0.02;            // [m]

/// The handle moves along the device's z axis. The wall's face is at z = 0, the wall below.
class Handle {
 public:
  double z = 0.5e-3, v = 0.0;

  void move(double force) {
    constexpr double h = kPeriod / kSubsteps;
    for (int i = 0; i < kSubsteps; ++i) {
      v += h * (force - kPress - kOwnDamping * v) / kMass;
      z += h * v;
    }
  }
};

double measureSwingAt(const Vec3& face_D, const Candidate* candidate, const Wall& wall) {
  CountedGrip grip;
  const Estimate estimate = candidate ? candidate->make() : Estimate();
  Handle handle;
  std::array<double, 2> forces{};  // newest first
  double top = -std::numeric_limits<double>::infinity(), bottom = -top;
  for (int i = 0; i < kTicks; ++i) {
    double z = handle.z, v = handle.v;
    if (estimate) {
      const CountedGrip::Reading reading = grip.read(face_D + Vec3(0.0, 0.0, handle.z));
      z = reading.pose.p_D.z() - face_D.z();
      v = estimate(i * kPeriod, reading).z();
    }
    forces = {z < 0.0 ? -wall.stiffness * z - wall.damping * v : 0.0, forces[0]};
    handle.move(forces[wall.late_by > 0 ? 1 : 0]);
    if (!(std::abs(handle.z) < kAway)) return std::numeric_limits<double>::infinity();
    if (i < kTicks - kEnd) continue;
    top = std::max(top, handle.z);
    bottom = std::min(bottom, handle.z);
  }
  return top - bottom;
}

}  // namespace

double measureSwing(const Candidate* candidate, const Wall& wall) {
  test::Random random(12);
  double worst = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const Vec3 face_D = Vec3(0.0, 0.0, 0.125) + random.inCube(0.015);
    worst = std::max(worst, measureSwingAt(face_D, candidate, wall));
  }
  return worst;
}

double findStiffest(const Candidate* candidate, Wall wall) {
  constexpr double kSoftest = 200.0, kStiffest = 40000.0, kRatio = 1.1;
  double stiffest = 0.0;
  for (wall.stiffness = kSoftest; wall.stiffness < kStiffest; wall.stiffness *= kRatio) {
    if (measureSwing(candidate, wall) > kCalm) break;
    stiffest = wall.stiffness;
  }
  return stiffest;
}

}  // namespace tandem::bench
