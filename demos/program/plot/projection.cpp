#include "plot/projection.h"

#include <algorithm>

namespace tandem::demos::plot {
namespace {

Vec3 screenRight() { return Vec3::UnitZ().cross(Projection::towardsViewer()).normalized(); }
Vec3 screenUp() { return Projection::towardsViewer().cross(screenRight()); }

enum class Occlusion { kNone, kFirstInFront, kSecondInFront };

// Which of two boxes can hide the other. An axis on which they lie apart decides; axes that
// contradict each other mean that neither can. Boxes may touch with some penetration.
Occlusion compare(const Bounds& a, const Bounds& b) {
  const Vec3 view = Projection::towardsViewer();
  const double slack = 0.2 * std::min(a.size().minCoeff(), b.size().minCoeff());
  bool is_first = false;
  bool is_second = false;
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_above = a.low[axis] >= b.high[axis] - slack;
    const bool is_below = b.low[axis] >= a.high[axis] - slack;
    is_first = is_first || (view[axis] > 0 ? is_above : is_below);
    is_second = is_second || (view[axis] > 0 ? is_below : is_above);
  }
  if (is_first && is_second) return Occlusion::kNone;
  if (is_first) return Occlusion::kFirstInFront;
  if (is_second) return Occlusion::kSecondInFront;
  // They overlap: the nearer centre is in front.
  return view.dot(a.centre() - b.centre()) > 0 ? Occlusion::kFirstInFront
                                               : Occlusion::kSecondInFront;
}

bool isRight(const std::vector<std::size_t>& order, const std::vector<Bounds>& bounds) {
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size(); ++j)
      if (compare(bounds[order[i]], bounds[order[j]]) == Occlusion::kFirstInFront) return false;
  return true;
}

// Draws next whatever hides none of those still to be drawn; in a cycle, the farthest.
std::vector<std::size_t> sorted(std::vector<std::size_t> rest, const std::vector<Bounds>& bounds) {
  const auto depth = [&](std::size_t b) {
    return Projection::towardsViewer().dot(bounds[b].centre());
  };
  std::sort(rest.begin(), rest.end(),
            [&](std::size_t a, std::size_t b) { return depth(a) < depth(b); });
  std::vector<std::size_t> order;
  while (!rest.empty()) {
    auto next = std::find_if(rest.begin(), rest.end(), [&](std::size_t candidate) {
      return std::none_of(rest.begin(), rest.end(), [&](std::size_t other) {
        return other != candidate &&
               compare(bounds[candidate], bounds[other]) == Occlusion::kFirstInFront;
      });
    });
    if (next == rest.end()) next = rest.begin();
    order.push_back(*next);
    rest.erase(next);
  }
  return order;
}

}  // namespace

Vec3 Projection::towardsViewer() { return Vec3(0.32, -0.78, 0.62).normalized(); }

Projection::Projection(const Bounds& bounds, double left, double top, double width) {
  Bounds seen;  // x: right, y: up, on the screen [m]
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p(corner & 1 ? bounds.high.x() : bounds.low.x(),
                 corner & 2 ? bounds.high.y() : bounds.low.y(),
                 corner & 4 ? bounds.high.z() : bounds.low.z());
    seen.include(Vec3(p.dot(screenRight()), p.dot(screenUp()), 0.0));
  }
  scale_ = width / seen.size().x();
  height_ = scale_ * seen.size().y();
  origin_ = {left - scale_ * seen.low.x(), top + scale_ * seen.high.y()};
}

Pixel Projection::project(const Vec3& p) const {
  return {origin_.x + scale_ * p.dot(screenRight()), origin_.y - scale_ * p.dot(screenUp())};
}

DrawingOrders orderForDrawing(const Run& run, const SceneMotion& motion,
                              const std::vector<std::size_t>& members) {
  DrawingOrders result;
  std::vector<Bounds> bounds(run.bodies.size());
  for (std::size_t frame = 0; frame < motion.frames(); ++frame) {
    for (const std::size_t b : members) bounds[b] = boundsOf(run.bodies[b], motion.poses[b][frame]);
    if (!result.orders.empty() && isRight(result.orders.back(), bounds)) continue;
    std::vector<std::size_t> order = sorted(members, bounds);
    if (!result.orders.empty() && result.orders.back() == order) continue;
    result.begins.push_back(frame);
    result.orders.push_back(std::move(order));
  }
  return result;
}

}  // namespace tandem::demos::plot
