#pragma once

#include <cstdint>

#include "island/island_model.h"

/// \file
/// Conditions for an island to sleep: nothing in it moves or would start to. A sleeping body stays
/// in place, so the distance left to its rest position must be negligible too.
namespace tandem {

/// True if the body ended `dt` [s] slower than 1e-9 m/s and 1e-9 rad/s. It must also accelerate by
/// less than 1e-6 m/s^2 and rad/s^2. A prescribed body must stand still; held bodies and empty
/// slots are always at rest.
[[nodiscard]] bool seemsAtRest(const ModelBody& before, const RigidState& after,
                               double dt) noexcept;

/// True if the body would stay in place. On couplers it is within 5e-13 m of its rest position;
/// without a coupler it stands still to rounding. `wrench` is the sum of all forces on it.
[[nodiscard]] bool isSettled(const IslandModel& model, BodyIndex body,
                             const Wrench& wrench) noexcept;

/// Hash of the shapes and poses of obstacles; null counts as none.
[[nodiscard]] std::uint64_t computeHash(const std::vector<Obstacle>* obstacles) noexcept;

}  // namespace tandem
