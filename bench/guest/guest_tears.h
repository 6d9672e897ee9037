#pragma once

#include "bench/guest/joint_rows.h"

namespace tandem::demos::bench {

class GuestWorld;

/// Energy that Bullet's solver gives the bodies of a joint as it closes it [J]:
///
///   c^T A^-1 c / 2,   A = J M^-1 J^T
///
/// c [m/s, rad/s] are the speeds at which it corrects the errors of the joint's rows. Bodies whose
/// host sees more mass than Bullet, as the copies of a shared object, count so many times. Motors,
/// springs, and limits that are kept give nothing. Zero for a joint that is off.
[[nodiscard]] double computeTear(btTypedConstraint& joint, const TearRates& rates,
                                 double share_a = 1.0, double share_b = 1.0);

/// The same of all joints of a world.
[[nodiscard]] double tearsOf(GuestWorld& world);

}  // namespace tandem::demos::bench
