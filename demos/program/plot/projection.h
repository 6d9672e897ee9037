#pragma once

#include <vector>

#include "plot/scene.h"

namespace tandem::demos::plot {

/// A point of the picture [px]; y downwards.
struct Pixel {
  double x = 0;
  double y = 0;
};

/// Parallel projection from above one side: x to the right, y away from the viewer, z up.
class Projection {
 public:
  /// Fits `bounds` into a picture of that width; the height follows.
  Projection(const Bounds& bounds, double left, double top, double width);

  [[nodiscard]] Pixel project(const Vec3& p) const;
  [[nodiscard]] double scale() const { return scale_; }  ///< [px/m]
  [[nodiscard]] double height() const { return height_; }

  /// Unit vector towards the viewer.
  [[nodiscard]] static Vec3 towardsViewer();

 private:
  double scale_ = 1;
  double height_ = 0;
  Pixel origin_;
};

/// Order in which to draw bodies so that nearer ones hide farther ones, frame by frame. An order is
/// kept for as long as it is right; `orders[k]` is in force from frame `begins[k]`.
struct DrawingOrders {
  std::vector<std::size_t> begins;
  std::vector<std::vector<std::size_t>> orders;
};

/// For the bodies listed in `members` (indices into `run.bodies`).
[[nodiscard]] DrawingOrders orderForDrawing(const Run& run, const SceneMotion& motion,
                                            const std::vector<std::size_t>& members);

}  // namespace tandem::demos::plot
