#include "bench/methods/all_methods.h"

#include "bench/engines/engine_methods.h"

namespace tandem::demos::bench {
namespace {

std::vector<std::unique_ptr<Method>> makeAll() {
  std::vector<std::unique_ptr<Method>> all;
  all.push_back(makePluginHandoff());
  all.push_back(makePluginLate());
  all.push_back(makePluginImpulse());
  all.push_back(makeForceInjection());
  all.push_back(makeSmallWorld());
  all.push_back(makeBulletRigid());
  all.push_back(makeBulletSoft());
  all.push_back(makeBulletSpring6Dof());
  all.push_back(makeBulletPointToPoint());
  for (auto& engine : makeEngineMethods()) all.push_back(std::move(engine));
  return all;
}

}  // namespace

const std::vector<std::unique_ptr<Method>>& allMethods() {
  static const std::vector<std::unique_ptr<Method>> all = makeAll();
  return all;
}

}  // namespace tandem::demos::bench
