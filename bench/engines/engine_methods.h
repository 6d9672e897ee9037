#pragma once

#include <memory>
#include <vector>

#include "bench/methods/method.h"

namespace tandem::demos::bench {

/// The other engines that were found when Tandem was configured, in the order of tables. Each is
/// optional: without its Debian package (scripts/packages.sh, group bench) it is not there.
[[nodiscard]] std::vector<std::unique_ptr<Method>> makeEngineMethods();

/// @name One factory for each engine, defined in the file that it is named after, if it is built.
/// @{
[[nodiscard]] std::unique_ptr<Method> makeMujoco();
[[nodiscard]] std::unique_ptr<Method> makeOde();
[[nodiscard]] std::unique_ptr<Method> makeSimbody();
/// @}

}  // namespace tandem::demos::bench
