#pragma once

#include <cmath>

#include "geometry/plain_vec.h"
#include "island/island_model.h"
#include "island/six.h"

namespace tandem {

/// Roots of a body's inverse mass and inertia in W, with its factors: I^-1 = root root^T. They lead
/// to units in which the body has mass and inertia 1, and back.
struct MassRoots {
  PlainVec mass_W;      ///< along the axes of W [kg^-1/2]
  PlainVec x, y, z;     ///< columns [kg^-1/2 m^-1]
  bool is_even = true;  ///< no factors

  MassRoots() = default;
  MassRoots(const ModelBody& body, const PlainRotation& R_WB) noexcept
      : is_even(body.factors.areEven()), inverse_mass_(body.inverse_mass) {
    const double root = std::sqrt(body.inverse_mass);
    mass_W = {root, root, root};
    const Vec3 turns_B = body.inverse_inertia_B.cwiseSqrt();
    x = turns_B.x() * R_WB.axisX();
    y = turns_B.y() * R_WB.axisY();
    z = turns_B.z() * R_WB.axisZ();
    if (!is_even) [[unlikely]]
      applyFactors(body.factors);
  }

  /// A direction n with its moment `turn` in the body's units.
  [[nodiscard]] Six scale(const PlainVec& n, const PlainVec& turn) const noexcept {
    Six six;
    multiplyEach(mass_W, n).store(six.at);
    PlainVec(dot(x, turn), dot(y, turn), dot(z, turn)).store(six.at + 3);
    return six;
  }
  /// Linear and angular part of what is given in the body's units.
  [[nodiscard]] PlainVec linear(const Six& six) const noexcept {
    return multiplyEach(mass_W, PlainVec(six.at));
  }
  [[nodiscard]] PlainVec angular(const Six& six) const noexcept {
    return six.at[3] * x + six.at[4] * y + six.at[5] * z;
  }
  /// Speed per impulse along a direction if there were no factors, for a body that has some.
  [[nodiscard]] double findFreeMobility(const PlainVec& n, const PlainVec& turn) const noexcept {
    const double about_x = dot(free_[0], turn), about_y = dot(free_[1], turn),
                 about_z = dot(free_[2], turn);
    return inverse_mass_ * dot(n, n) + about_x * about_x + about_y * about_y + about_z * about_z;
  }

 private:
  void applyFactors(const MassFactors& factors) noexcept {
    free_[0] = x, free_[1] = y, free_[2] = z;
    const PlainVec turn_root_W(factors.turn_root_W);
    mass_W = multiplyEach(mass_W, PlainVec(Vec3(factors.way_W.cwiseSqrt())));
    for (PlainVec* column : {&x, &y, &z}) *column = multiplyEach(turn_root_W, *column);
  }

  double inverse_mass_ = 0.0;
  PlainVec free_[3];  ///< x, y, z without factors, of a body that has some
};

}  // namespace tandem
