// Time of the host's thread to take a convex hull of many points in: for the first time, and when a
// shape with the same points comes again. Prints medians and maxima over the turns.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <vector>

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>

#include "tandem/bullet_bridge/convert.h"
#include "tandem/bullet_bridge/shapes.h"

#include "support/random.h"

namespace tandem {
namespace {

constexpr int kPoints = 4000, kTurns = 21;
constexpr double kRadius = 0.05;  // [m]

/// Processor time of this process [ms].
double now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

void printTimes(const char* name, bool on_ball) {
  std::vector<double> first, again;
  for (std::uint64_t turn = 1; turn <= kTurns; ++turn) {
    test::Random random(turn);
    btConvexHullShape shape;
    for (int i = 0; i < kPoints; ++i) {
      const Vec3 p = random.inCube(1.0);
      shape.addPoint(toBullet(Vec3(kRadius * (on_ball ? p.normalized() : p))), false);
    }
    shape.recalcLocalAabb();
    for (std::vector<double>* times : {&first, &again}) {
      const double start = now();
      (void)convertShape(shape);
      times->push_back(now() - start);
    }
  }
  for (std::vector<double>* times : {&first, &again}) std::sort(times->begin(), times->end());
  std::printf("%d points %s: first %.2f ms (at most %.2f), again %.3f ms (at most %.3f)\n", kPoints,
              name, first[kTurns / 2], first.back(), again[kTurns / 2], again.back());
}

}  // namespace
}  // namespace tandem

int main() {
  tandem::printTimes("on a ball, all corners", true);
  tandem::printTimes("in a cube", false);
}
