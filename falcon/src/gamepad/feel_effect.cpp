#include "gamepad/feel_effect.h"

#include <algorithm>
#include <cmath>

#include "guard/force_limit.h"

namespace tandem {
namespace {

constexpr double kFullRumble = 0xFFFF;
constexpr double kFullForce = 0x7FFF;  // the kernel's level is signed: 0x8000 would turn it round
constexpr double kLeastShare = 0.01;
constexpr double kTurn = 0x10000;  // directions in a full turn
constexpr double kTwoPi = 6.283185307179586;

std::uint16_t makeLevel(double share, double full) noexcept {
  if (!(share >= kLeastShare)) return 0;
  return static_cast<std::uint16_t>(std::lround(std::min(share, 1.0) * full));
}

/// A force to the right comes from the left, and so on.
std::uint16_t makeDirection(const Vec3& f_D) noexcept {
  const double turns = std::atan2(f_D.x(), -f_D.z()) / kTwoPi;
  return static_cast<std::uint16_t>(std::lround((turns + 1.0) * kTurn));
}

}  // namespace

FeelEffect makeFeelEffect(Feel feel, const Vec3& f_D, double max_force) noexcept {
  FeelEffect effect;
  effect.kind = feel;
  const Vec3 share_D = falcon_detail::shorten(f_D, max_force) / max_force;
  if (feel == Feel::kRumble) effect.level = makeLevel(share_D.norm(), kFullRumble);
  if (feel == Feel::kForce) {
    effect.level = makeLevel(std::hypot(share_D.x(), share_D.z()), kFullForce);
    if (effect.level > 0) effect.direction = makeDirection(share_D);
  }
  return effect;
}

}  // namespace tandem
