#pragma once

#include "world/rotation.h"

namespace tandem::demos {

/// Mass, centre of mass and inertia of bodies that move as one.
class MassSum {
 public:
  /// Adds a body. `I_W` is its inertia about its own centre of mass, in W [kg m^2].
  void add(double mass, const Vec3& p_W, const Mat3& I_W);

  [[nodiscard]] double mass() const { return mass_; }           ///< [kg]
  [[nodiscard]] Vec3 centre() const { return first_ / mass_; }  ///< in W [m]
  /// About the centre, in W [kg m^2].
  [[nodiscard]] Mat3 inertia() const;

 private:
  double mass_ = 0.0;
  Vec3 first_ = Vec3::Zero();         // moment of mass about the origin [kg m]
  Mat3 about_origin_ = Mat3::Zero();  // [kg m^2]
};

/// Axes in which an inertia has no products, as a rotation: `wish` if it is such, so that boxes
/// keep their own axes.
[[nodiscard]] Mat3 findPrincipalAxes(const Mat3& I_W, const Mat3& wish);

}  // namespace tandem::demos
