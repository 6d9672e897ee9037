#pragma once

#include "scenario/scenario.h"

namespace tandem::demos {

/// The place in the scene's frame where a user's device starts, `site` counted from 0, without the
/// user's own offset [m]. Without an object the users stand in a row along x, each just in contact
/// with the next; users 1 and 2 touch in the origin. With one, the first, third and so on stand at
/// its face at -x, the others at +x. Several at a face form a grid around its middle. In a world:
/// the origin.
[[nodiscard]] Vec3 computeUserPlace(const Scenario& scenario, std::size_t site);

/// The same beside any object whose middle is the origin: `distance` from it along x [m].
[[nodiscard]] Vec3 computePlaceBeside(const Scenario& scenario, std::size_t site, double distance);

/// The number of users who stand beside `site` at the same face, with that one.
[[nodiscard]] std::size_t countBeside(const Scenario& scenario, std::size_t site);

/// The least edge of a cube on whose faces all users find a place [m]; 0 for one user a face.
[[nodiscard]] double computeLeastFace(const Scenario& scenario);

}  // namespace tandem::demos
