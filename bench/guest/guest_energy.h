#pragma once

#include "bench/guest/guest_world.h"

namespace tandem::demos::bench {

[[nodiscard]] Vec3 placeOf(const GuestBody& body);
/// True if a body is near enough to the scene to be judged.
[[nodiscard]] bool isInArena(const GuestBody& body);
/// True if forces move it.
[[nodiscard]] bool isMoving(const GuestBody& body);
/// True if its centre is lower than that of any body that stands on the floor.
[[nodiscard]] bool isBelowAll(const GuestWorld& world, const GuestBody& body);
/// Energy of motion and weight of all bodies in the arena and of all arms, as the host sees it [J].
[[nodiscard]] double energyOf(const GuestWorld& world);
/// The part of bodies that cannot move along some axes. A mover beside one is a wedge, and drives
/// it at any speed [J].
[[nodiscard]] double energyOnRails(const GuestWorld& world);
/// Index of the body with the most energy.
[[nodiscard]] std::size_t findLiveliest(const GuestWorld& world);

}  // namespace tandem::demos::bench
