#include "run/common_motion.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tandem::demos {
namespace {

/// Slower is standing still [m/s].
constexpr double kStill = 1e-6;

}  // namespace

std::optional<double> CommonMotion::drag() const {
  if (std::abs(speed) < kStill) return std::nullopt;
  return force / speed;
}

CommonMotion computeCommonMotion(const std::vector<const Recording*>& sites, const Vec3& axis_W) {
  CommonMotion motion;
  double ticks = 0.0;
  for (const Recording* site : sites) {
    for (std::size_t i = site->ticks().size() / 2; i < site->ticks().size(); ++i) {
      const TickRecord& tick = site->ticks()[i];
      motion.speed += axis_W.dot(tick.device.hip.v_W);
      motion.force -= axis_W.dot(tick.f_W);
      ticks += 1.0;
    }
  }
  motion.speed /= ticks;
  motion.force /= ticks;
  return motion;
}

FeltShares computeFelt(const Recording& site, double radius) {
  FeltShares felt;
  felt.users.resize(static_cast<std::size_t>(site.proxyCount()));
  for (std::size_t i = 0; i < site.ticks().size(); ++i) {
    const TickRecord& tick = site.ticks()[i];
    if (!tick.contact) continue;
    bool is_user = false;
    for (int remote = 0; remote < site.proxyCount(); ++remote) {
      const Vec3 apart = tick.device.hip.p_W - site.proxy(i, remote).island.p_W;
      if (!(apart.norm() < 2.0 * radius)) continue;
      felt.users[static_cast<std::size_t>(remote)] += 1.0;
      is_user = true;
    }
    if (!is_user) felt.rest += 1.0;
  }
  const auto ticks = static_cast<double>(site.ticks().size());
  felt.rest /= ticks;
  for (double& user : felt.users) user /= ticks;
  return felt;
}

nlohmann::json describeFelt(const FeltShares& felt, std::size_t own) {
  nlohmann::json j = {{"object", felt.rest}};
  for (std::size_t remote = 0; remote < felt.users.size(); ++remote)
    j[fmt::format("site{}", (remote < own ? remote : remote + 1) + 1)] = felt.users[remote];
  return j;
}

}  // namespace tandem::demos
