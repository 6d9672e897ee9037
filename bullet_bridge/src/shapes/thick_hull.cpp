#include "shapes/thick_hull.h"

#include <algorithm>
#include <utility>

#include <Eigen/Eigenvalues>

#include "coordination/src/geometry/convex_polyhedron.h"
#include "shapes/hull_cache.h"

namespace tandem {
namespace {

using Mat3 = Eigen::Matrix3d;

/// Extent of the points along a direction [m].
double computeExtent(const std::vector<Vec3>& points, const Vec3& direction) {
  double low = direction.dot(points.front()), high = low;
  for (const Vec3& p : points) {
    low = std::min(low, direction.dot(p));
    high = std::max(high, direction.dot(p));
  }
  return high - low;
}

/// Principal axes of the points, as columns.
Mat3 findAxes(const std::vector<Vec3>& points) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : points) spread += (p - middle) * (p - middle).transpose();
  return Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors();
}

/// A point of a solid, and how far it is in front of the face for which it was asked [m].
struct Sample {
  double height;
  Vec3 p;
};

/// Points that are in front of the solid's faces by more than `least`, farthest first.
std::vector<Sample> findOutside(const ConvexPolyhedron& solid, const Support& support,
                                double least) {
  std::vector<Sample> outside;
  for (const ConvexPolyhedron::Face& face : solid.faces()) {
    const Vec3 p = support(face.normal);
    const double height = face.normal.dot(p) - face.offset;
    if (height > least) outside.push_back({height, p});
  }
  std::stable_sort(outside.begin(), outside.end(),
                   [](const Sample& a, const Sample& b) { return a.height > b.height; });
  return outside;
}

std::vector<Vec3> sampleCoarsely(const Support& support) {
  std::vector<Vec3> points;
  for (int i = 0; i < 27; ++i) {
    const Vec3 direction(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (direction != Vec3::Zero()) points.push_back(support(direction.normalized()));
  }
  return points;
}

}  // namespace

std::optional<Shape> makeThickHull(const std::vector<Vec3>& points, double rounding) {
  const auto is_finite = [](const Vec3& p) { return p.allFinite(); };
  if (points.empty() || !std::all_of(points.begin(), points.end(), is_finite)) return std::nullopt;
  if (auto solid = HullCache::ofProcess().find(points)) return ConvexHull{solid, rounding};
  const Mat3 axes = findAxes(points);
  double size = rounding;
  for (int i = 0; i < 3; ++i) size = std::max(size, computeExtent(points, axes.col(i)));
  const double half = kThin * size;
  std::vector<Vec3> thick = points;
  for (int i = 0; i < 3; ++i) {
    if (computeExtent(points, axes.col(i)) > half) continue;
    const std::size_t count = thick.size();
    for (std::size_t k = 0; k < count; ++k) {
      thick.emplace_back(thick[k] - half * axes.col(i));
      thick[k] += half * axes.col(i);
    }
  }
  auto solid = HullCache::ofProcess().find(thick);
  if (!solid) return std::nullopt;
  return ConvexHull{std::move(solid), std::max(0.0, rounding - half)};
}

std::optional<Shape> makeSampledHull(const Support& support, double rounding) {
  std::vector<Vec3> points = sampleCoarsely(support);
  double size = 0.0;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
    size = std::max(size, computeExtent(points, axis));
  while (static_cast<int>(points.size()) < kMostSamples) {
    const auto solid = HullCache::make(points);
    if (!solid) break;
    points = solid->vertices();
    const std::size_t room = static_cast<std::size_t>(kMostSamples) - points.size();
    const std::vector<Sample> outside = findOutside(*solid, support, kSampleError * size);
    if (outside.empty()) break;
    for (std::size_t i = 0; i < std::min(room, outside.size()); ++i) points.push_back(outside[i].p);
  }
  return makeThickHull(points, rounding);
}

}  // namespace tandem
