#pragma once

#include <cstdint>

#include "island/island_model.h"

/// \file
/// When an island may sleep: nothing in it moves, and nothing would. As a sleeping body stays where
/// it is, what it would still have gone must not matter either.
namespace tandem {

/// True if the body was slower than 1e-9 m/s and 1e-9 rad/s at the end of `dt` [s], and changed
/// that by less than 1e-6 m/s^2 and rad/s^2. A prescribed body must stand still; one that is held
/// and an empty slot always rest.
[[nodiscard]] bool seemsAtRest(const ModelBody& before, const RigidState& after,
                               double dt) noexcept;

/// True if the body would stay: on couplers it has less than 5e-13 m to go to its rest; one that
/// nothing ties stands still to rounding. `wrench` is all that acts on it now.
[[nodiscard]] bool isSettled(const IslandModel& model, BodyIndex body,
                             const Wrench& wrench) noexcept;

/// Equal for obstacles of equal shape in equal places; null is none.
[[nodiscard]] std::uint64_t computeHash(const std::vector<Obstacle>* obstacles) noexcept;

}  // namespace tandem
