#pragma once

#include <cmath>

#include "geometry/plain_vec.h"
#include "island/island_model.h"
#include "island/six.h"

namespace tandem {

/// Roots of a body's inverse mass and inertia in W, with its factors: I^-1 = root root^T. They lead
/// to units in which the body has mass and inertia 1, and back.
struct MassRoots {
  PlainVec mass_W;   ///< along the axes of W [kg^-1/2]
  PlainVec x, y, z;  ///< columns [kg^-1/2 m^-1]

  MassRoots() = default;
  MassRoots(const ModelBody& body, const PlainRotation& R_WB) noexcept {
    const double root = std::sqrt(body.inverse_mass);
    mass_W = {root, root, root};
    const Vec3 turns_B = body.inverse_inertia_B.cwiseSqrt();
    x = turns_B.x() * R_WB.axisX();
    y = turns_B.y() * R_WB.axisY();
    z = turns_B.z() * R_WB.axisZ();
    if (!body.factors.areEven()) [[unlikely]]
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
  /// Greatest inverse inertia about any axis, or more [1/(kg m^2)].
  [[nodiscard]] double mostTurning() const noexcept { return dot(x, x) + dot(y, y) + dot(z, z); }

 private:
  void applyFactors(const MassFactors& factors) noexcept {
    const PlainVec turn_root_W(factors.turn_root_W);
    mass_W = multiplyEach(mass_W, PlainVec(Vec3(factors.way_W.cwiseSqrt())));
    for (PlainVec* column : {&x, &y, &z}) *column = multiplyEach(turn_root_W, *column);
  }
};

}  // namespace tandem
