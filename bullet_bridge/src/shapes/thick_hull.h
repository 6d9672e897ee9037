#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "tandem/coordination/shape.h"

namespace tandem {

/// Half thickness given to a hull without volume, as a share of its size.
constexpr double kThin = 1e-4;

/// Hull of the points with a rounding [m]. Points in a plane, on a line or at one place become a
/// solid of half thickness kThin, which counts as part of the rounding: the surface stays where it
/// is if the rounding is thicker. Nothing if there are no points or they are not finite.
[[nodiscard]] std::optional<Shape> makeThickHull(const std::vector<Vec3>& points, double rounding);

/// The farthest point of a convex solid along a unit direction.
using Support = std::function<Vec3(const Vec3&)>;

/// Most points that makeSampledHull() takes.
constexpr int kMostSamples = 600;
/// makeSampledHull() is satisfied with this share of the size.
constexpr double kSampleError = 2e-4;

/// Hull of points of a convex solid. It is inside the solid, and the solid is farther out than a
/// face by kSampleError of its size at most, unless that takes more than kMostSamples points.
[[nodiscard]] std::optional<Shape> makeSampledHull(const Support& support, double rounding);

}  // namespace tandem
