#pragma once

#include <vector>

#include "tandem/coordination/shape.h"

#include "geometry/plain_vec.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A shape and its pose in a body, for a compound.
struct ShapePart {
  Shape shape;
  Vec3 p_BC = Vec3::Zero();  ///< origin of the shape's frame C [m]
  Quat q_BC = Quat::Identity();
};

/// The shapes of a compound. Immutable; built at set-up. A Compound refers to it.
class CompoundParts {
 public:
  /// A shape with its pose, and a ball that holds it.
  struct Part {
    Shape shape;  ///< no compound, no plane
    Vec3 p_BC;
    Quat q_BC;
    PlainRotation R_BC;
    Vec3 middle_B;        ///< of the ball, in the body's frame [m]
    double radius = 0.0;  ///< of the ball [m]

    /// A point or direction of the body's frame in that of the shape, and back.
    [[nodiscard]] PlainVec toPart(const PlainVec& p_B) const noexcept {
      return R_BC.toBody(p_B - PlainVec(p_BC));
    }
    [[nodiscard]] PlainVec toBody(const PlainVec& direction_C) const noexcept {
      return R_BC.toWorld(direction_C);
    }
  };

  /// Compounds among the shapes are replaced by their own parts. Throws std::invalid_argument if
  /// there is no shape, if one is a plane or has a size out of range, or if a pose is not finite.
  explicit CompoundParts(const std::vector<ShapePart>& shapes);

  [[nodiscard]] const std::vector<Part>& all() const noexcept { return parts_; }
  /// Radius of the sphere around the body's origin that holds all parts [m].
  [[nodiscard]] double boundingRadius() const noexcept { return bounding_radius_; }

 private:
  void add(const ShapePart& shape);

  std::vector<Part> parts_;
  double bounding_radius_ = 0.0;
};

/// Throws as CompoundParts does.
[[nodiscard]] Compound makeCompound(const std::vector<ShapePart>& shapes);

}  // namespace tandem
#pragma GCC visibility pop
