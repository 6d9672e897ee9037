#pragma once

#include "tandem/coordination/stability.h"
#include "tandem/falcon/simulated_device.h"

namespace tandem::test {

/// A hand that presses along x with a force that rises smoothly and then stays. Besides, it may
/// hold the handle by spring and damper, along x and across, and by others that calm the start.
class PressingHand final : public Hand {
 public:
  static constexpr double kRise = 3.0;  ///< time in which the force rises [s]

  /// `across` holds the handle beside the line, where there is no guide.
  PressingHand(double force, const Vec3& start_W, const HandImpedance& hand,
               const HandImpedance& calm, const HandImpedance& across)
      : force_(force), start_W_(start_W), hand_(hand), calm_(calm), across_(across) {}

  [[nodiscard]] Vec3 computeForce(double t, const PointState& handle) const noexcept override {
    const Vec3 way_W = handle.p_W - start_W_;
    const Vec3& v_W = handle.v_W;
    Vec3 f_W = -across_.stiffness * way_W - across_.damping * v_W;
    f_W.x() = force_ * computeRise(t) + kept_ + pull + nudge -
              (hand_.stiffness + calm_.stiffness) * way_W.x() -
              (hand_.damping + calm_.damping) * v_W.x();
    return f_W;
  }

  /// Ends the calm. The force of its spring, as it is now, stays.
  void letGo(const PointState& handle) noexcept {
    kept_ = -calm_.stiffness * (handle.p_W - start_W_).x();
    calm_ = {};
  }

  double pull = 0.0;   ///< besides, from now on [N]
  double nudge = 0.0;  ///< besides, in this tick [N]

 private:
  [[nodiscard]] static double computeRise(double t) noexcept {
    if (t >= kRise) return 1.0;
    const double u = t / kRise;
    return u * u * u * (10.0 + u * (-15.0 + u * 6.0));
  }

  double force_, kept_ = 0.0;
  Vec3 start_W_;
  HandImpedance hand_, calm_, across_;
};

}  // namespace tandem::test
