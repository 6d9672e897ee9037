#pragma once

#include "island/island_model.h"

namespace tandem {

/// True if two bodies of a guided island can meet. False if they start so far apart across the
/// guide that they pass each other on parallel lines.
[[nodiscard]] bool canMeet(const IslandModel& model, BodyIndex one, BodyIndex other);

}  // namespace tandem
