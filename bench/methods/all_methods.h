#pragma once

#include <memory>
#include <vector>

#include "bench/methods/method.h"

namespace tandem::demos::bench {

/// Every method that was built in, in the order of tables and legends.
[[nodiscard]] const std::vector<std::unique_ptr<Method>>& allMethods();

/// @name One factory for each way to simulate, defined in the file that it is named after.
/// @{
[[nodiscard]] std::unique_ptr<Method> makePluginHandoff();
[[nodiscard]] std::unique_ptr<Method> makePluginLate();
[[nodiscard]] std::unique_ptr<Method> makePluginImpulse();
[[nodiscard]] std::unique_ptr<Method> makeForceInjection();
[[nodiscard]] std::unique_ptr<Method> makeBulletRigid();
[[nodiscard]] std::unique_ptr<Method> makeBulletSoft();
[[nodiscard]] std::unique_ptr<Method> makeBulletSpring6Dof();
[[nodiscard]] std::unique_ptr<Method> makeBulletPointToPoint();
/// @}

}  // namespace tandem::demos::bench
