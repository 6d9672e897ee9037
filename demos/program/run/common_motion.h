#pragma once

#include <optional>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tandem/plugin/recording.h"

namespace tandem::demos {

/// The force that holds all users back when they move together: means over all sites and the last
/// half of a run, along the axis.
struct CommonMotion {
  double speed = 0.0;  ///< of the devices [m/s]
  double force = 0.0;  ///< with which each user is held back: minus the force on the device [N]

  /// The drag of each site [N s/m], without the device's own damping; empty if nothing moves. It
  /// means something once all move evenly: until then the bodies' inertia is in it.
  [[nodiscard]] std::optional<double> drag() const;
};

/// `axis_W` is the axis in W; there is a recording of each site.
[[nodiscard]] CommonMotion computeCommonMotion(const std::vector<const Recording*>& sites,
                                               const Vec3& axis_W);

/// Shares of a run's ticks in which a user's device feels others.
struct FeltShares {
  std::vector<double> users;  ///< each remote user, in the site's order
  double rest = 0.0;          ///< contact with no user: the object, or other bodies
};

/// Tells whom the device of a recorded site feels. A user is felt while there is contact and the
/// spheres of device and proxy, each of `radius` [m], overlap.
[[nodiscard]] FeltShares computeFelt(const Recording& site, double radius);

/// The keys of contacts.siteN in summary.json; the site `own` counts from 0.
[[nodiscard]] nlohmann::json describeFelt(const FeltShares& felt, std::size_t own);

}  // namespace tandem::demos
