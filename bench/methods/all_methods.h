#pragma once

#include <memory>
#include <vector>

#include "bench/methods/method.h"

namespace tandem::demos::bench {

/// Every built-in method, in the order of tables and legends.
[[nodiscard]] const std::vector<std::unique_ptr<Method>>& allMethods();

/// @name Factories, one for each method, defined in the file with its name.
/// @{
[[nodiscard]] std::unique_ptr<Method> makePluginHandoff();
[[nodiscard]] std::unique_ptr<Method> makePluginLate();
[[nodiscard]] std::unique_ptr<Method> makePluginImpulse();
[[nodiscard]] std::unique_ptr<Method> makeForceInjection();
[[nodiscard]] std::unique_ptr<Method> makeSmallWorld();
[[nodiscard]] std::unique_ptr<Method> makeBulletRigid();
[[nodiscard]] std::unique_ptr<Method> makeBulletSoft();
[[nodiscard]] std::unique_ptr<Method> makeBulletSpring6Dof();
[[nodiscard]] std::unique_ptr<Method> makeBulletPointToPoint();
/// @}

}  // namespace tandem::demos::bench
