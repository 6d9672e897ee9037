#include <cmath>

#include "tandem/falcon/simulated_device.h"

#include "guard/settings_check.h"

namespace tandem {
namespace {

class SineHand final : public Hand {
 public:
  SineHand(const Vec3& f_W, double frequency, double phase)
      : f_W_(f_W), frequency_(frequency), phase_(phase) {}

  Vec3 computeForce(double t, const PointState& /*handle*/) const noexcept override {
    constexpr double kTwoPi = 6.283185307179586476925286766559;
    return f_W_ * std::sin(kTwoPi * frequency_ * t + phase_);
  }

 private:
  Vec3 f_W_;
  double frequency_;
  double phase_;
};

}  // namespace

std::unique_ptr<Hand> makeSineHand(const Vec3& f_W, double frequency, double phase) {
  using falcon_detail::require;
  require(f_W.allFinite(), "force of the sine hand", f_W, "finite [N]");
  require(std::isfinite(frequency) && frequency >= 0.0, "frequency of the sine hand", frequency,
          "finite and at least 0 [Hz]");
  require(std::isfinite(phase), "phase of the sine hand", phase, "finite [rad]");
  return std::make_unique<SineHand>(f_W, frequency, phase);
}

}  // namespace tandem
