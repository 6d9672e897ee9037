#pragma once

#include <LinearMath/btScalar.h>

namespace tandem::demos::bench {

/// A number in the width of the host's Bullet.
[[nodiscard]] inline btScalar scalar(double number) { return static_cast<btScalar>(number); }

}  // namespace tandem::demos::bench
