#include <algorithm>
#include <cmath>

#include "tandem/coordination/link.h"

namespace tandem {
namespace {

constexpr double kUnitTolerance = 1e-6;

bool isSane(const ObjectState& object) noexcept {
  // This form also refuses huge finite coefficients, whose norm is infinite.
  return isFinite(object.state) && std::abs(object.state.q_WB.norm() - 1.0) <= kUnitTolerance;
}

bool isSane(const GripState& grip) noexcept {
  return grip.p_BG.allFinite() && std::abs(grip.q_BG.norm() - 1.0) <= kUnitTolerance &&
         std::isfinite(grip.age) && grip.age >= 0.0;
}

}  // namespace

bool isSane(const StatePacket& packet) noexcept {
  if (packet.object_count > packet.objects.size()) return false;
  if (!std::isfinite(packet.time) || !isFinite(packet.user)) return false;
  if (packet.energy &&
      !(std::isfinite(packet.energy->granted) && std::isfinite(packet.energy->holdings)))
    return false;
  if (packet.grip && !isSane(*packet.grip)) return false;
  if (packet.roll && !(std::isfinite(packet.roll->age) && packet.roll->age >= 0.0)) return false;
  const auto* const first = packet.objects.data();
  return std::all_of(first, first + packet.object_count,
                     [](const ObjectState& object) { return isSane(object); });
}

}  // namespace tandem
