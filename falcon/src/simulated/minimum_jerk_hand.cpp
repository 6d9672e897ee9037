#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "tandem/falcon/simulated_device.h"

#include "coordination/src/island/virtual_coupler.h"
#include "guard/settings_check.h"

namespace tandem {
namespace {

/// State at time `t` of a stroke from rest at `from` to rest at `to`, from.t <= t < to.t. Source:
/// Flash & Hogan 1985, the path of least integrated squared jerk.
PointState computeStroke(const Waypoint& from, const Waypoint& to, double t) noexcept {
  const double duration = to.t - from.t;
  const double u = (t - from.t) / duration;
  const double rest = 1.0 - u;
  const double travelled = u * u * u * (10.0 + u * (-15.0 + u * 6.0));
  const double rate = 30.0 * u * u * rest * rest / duration;  // [1/s], peak 1.875 / duration
  const Vec3 way = to.p_W - from.p_W;
  return {from.p_W + travelled * way, rate * way};
}

class MinimumJerkHand final : public Hand {
 public:
  MinimumJerkHand(std::vector<Waypoint> waypoints, const CouplerGains& gains)
      : waypoints_(std::move(waypoints)), gains_(gains) {}

  Vec3 computeForce(double t, const PointState& handle) const noexcept override {
    return computeCouplerForce(gains_, computeReference(t), handle);
  }

 private:
  PointState computeReference(double t) const noexcept {
    const auto next =
        std::upper_bound(waypoints_.begin(), waypoints_.end(), t,
                         [](double time, const Waypoint& waypoint) { return time < waypoint.t; });
    if (next == waypoints_.begin()) return {waypoints_.front().p_W, Vec3::Zero()};
    if (next == waypoints_.end()) return {waypoints_.back().p_W, Vec3::Zero()};
    return computeStroke(*std::prev(next), *next, t);
  }

  std::vector<Waypoint> waypoints_;
  CouplerGains gains_;
};

void requireWaypoints(const std::vector<Waypoint>& waypoints) {
  using falcon_detail::require;
  if (waypoints.empty()) {
    throw std::invalid_argument("minimum-jerk hand has 0 waypoints, needs 1 or more");
  }
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const std::string name = "waypoint " + std::to_string(i) + " of the minimum-jerk hand: ";
    const Waypoint& waypoint = waypoints[i];
    require(waypoint.p_W.allFinite(), name + "position", waypoint.p_W, "finite [m]");
    require(std::isfinite(waypoint.t), name + "time", waypoint.t, "finite [s]");
    if (i == 0) continue;
    const double before = waypoints[i - 1].t;
    require(waypoint.t > before && std::isfinite(waypoint.t - before), name + "time", waypoint.t,
            "later than the one before, " + falcon_detail::toText(before) + " s");
  }
}

}  // namespace

std::unique_ptr<Hand> makeMinimumJerkHand(std::vector<Waypoint> waypoints, double stiffness,
                                          double damping) {
  using falcon_detail::require;
  requireWaypoints(waypoints);
  require(std::isfinite(stiffness) && stiffness >= 0.0, "stiffness of the minimum-jerk hand",
          stiffness, "finite and at least 0 [N/m]");
  require(std::isfinite(damping) && damping >= 0.0, "damping of the minimum-jerk hand", damping,
          "finite and at least 0 [N s/m]");
  return std::make_unique<MinimumJerkHand>(std::move(waypoints), CouplerGains{stiffness, damping});
}

}  // namespace tandem
