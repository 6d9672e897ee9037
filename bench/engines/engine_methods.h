#pragma once

#include <memory>
#include <vector>

#include "bench/methods/method.h"

namespace tandem::demos::bench {

/// The other engines found when Tandem was configured, in the order of tables. Each is optional: it
/// is missing without its Debian package (scripts/packages.sh, group bench).
[[nodiscard]] std::vector<std::unique_ptr<Method>> makeEngineMethods();

/// Throws NotApplicable for a scene with a belt: these engines' bodies without mass stand still.
void refuseBelts(const BenchScene& scene);

/// Throws NotApplicable for a scene with joints.
void refuseJoints(const BenchScene& scene);

/// @name Factories, one for each engine that is built, defined in the file with its name.
/// @{
[[nodiscard]] std::unique_ptr<Method> makeMujoco();
[[nodiscard]] std::unique_ptr<Method> makeOde();
[[nodiscard]] std::unique_ptr<Method> makeSimbody();
/// @}

}  // namespace tandem::demos::bench
