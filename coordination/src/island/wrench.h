#pragma once

#include "tandem/coordination/types.h"

namespace tandem {

/// Force and torque about the centre of mass, in W [N, N m].
struct Wrench {
  Vec3 f_W = Vec3::Zero();
  Vec3 t_W = Vec3::Zero();
};

/// A wrench that changes evenly during a step.
struct HeldWrench {
  Wrench start;
  Wrench rate;  ///< [N/s], [N m/s]

  void add(const Wrench& at_start, const Wrench& its_rate, double sign) noexcept {
    start.f_W += sign * at_start.f_W;
    start.t_W += sign * at_start.t_W;
    rate.f_W += sign * its_rate.f_W;
    rate.t_W += sign * its_rate.t_W;
  }
};

}  // namespace tandem
