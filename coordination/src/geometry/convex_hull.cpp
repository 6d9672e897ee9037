#include <stdexcept>
#include <utility>

#include "geometry/convex_polyhedron.h"
#include "geometry/flat_faces.h"
#include "geometry/quick_hull.h"

namespace tandem {
namespace {

/// Shares of the size, the next one for points that rounding scatters too far for the last.
constexpr double kPrecisions[] = {1e-7, 1e-6, 1e-5};

/// Points that are corners, in the order in which the faces name them; renumbers these.
std::vector<Vec3> takeCorners(const std::vector<Vec3>& points, FaceList& faces) {
  std::vector<int> place(points.size(), -1);
  std::vector<Vec3> corners;
  corners.reserve(points.size());
  for (int& corner : faces.corners) {
    int& known = place[static_cast<std::size_t>(corner)];
    if (known < 0) {
      known = static_cast<int>(corners.size());
      corners.push_back(points[static_cast<std::size_t>(corner)]);
    }
    corner = known;
  }
  return corners;
}

}  // namespace

ConvexPolyhedron ConvexPolyhedron::makeHull(const std::vector<Vec3>& points) {
  for (const double precision : kPrecisions) {
    const std::optional<HullTriangles> hull = makeHullTriangles(points, precision);
    if (!hull) continue;
    std::optional<FaceList> faces = joinFlatFaces(points, *hull);
    if (!faces) continue;
    std::vector<Vec3> corners = takeCorners(points, *faces);
    return ConvexPolyhedron(std::move(corners), *faces);
  }
  throw std::invalid_argument("a convex hull of these points is lost in rounding");
}

}  // namespace tandem
