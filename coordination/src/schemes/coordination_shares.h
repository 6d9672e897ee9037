#pragma once

#include <algorithm>

#include "tandem/coordination/coupling_settings.h"

#include "island/virtual_coupler.h"

namespace tandem {

/// The parts that couplers and stand-ins have with N sites.
///
///                            sum    average
///     coupler of two copies   1      1/N         of K_t, B_t
///     a user's stand-in       1      1/(N-1)     of mass, damping, coupler and contact
///
/// The mean of all copies, ours without delay, pulls as N-1 couplers of 1/N do. Whole stand-ins
/// would outweigh the copy of m/N that they push: from three sites on they make it unstable.
struct CoordinationShares {
  double object = 1.0;
  double stand_in = 1.0;
};

/// `sites`: N, at least 1.
[[nodiscard]] inline CoordinationShares computeShares(CoordinationMode mode, int sites) noexcept {
  if (mode == CoordinationMode::kSum) return {};
  return {1.0 / sites, 1.0 / std::max(1, sites - 1)};
}

/// A stand-in that has the share `share` of a whole user.
[[nodiscard]] inline StandInSettings makeStandIn(const ProxySettings& whole,
                                                 const CouplerGains& gains, double share) noexcept {
  StandInSettings part{share, whole, computeShare(gains, share)};
  part.proxy.mass *= share;
  part.proxy.damping *= share;
  return part;
}

}  // namespace tandem
