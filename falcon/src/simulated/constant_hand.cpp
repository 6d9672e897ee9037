#include "tandem/falcon/simulated_device.h"

#include "guard/settings_check.h"

namespace tandem {
namespace {

class ConstantHand final : public Hand {
 public:
  explicit ConstantHand(const Vec3& f_W) : f_W_(f_W) {}

  Vec3 computeForce(double /*t*/, const PointState& /*handle*/) const noexcept override {
    return f_W_;
  }

 private:
  Vec3 f_W_;
};

}  // namespace

std::unique_ptr<Hand> makeConstantHand(const Vec3& f_W) {
  falcon_detail::require(f_W.allFinite(), "force of the constant hand", f_W, "finite [N]");
  return std::make_unique<ConstantHand>(f_W);
}

}  // namespace tandem
