#include "bench/engines/engine_methods.h"

namespace tandem::demos::bench {

std::vector<std::unique_ptr<Method>> makeEngineMethods() {
  std::vector<std::unique_ptr<Method>> engines;
#ifdef TANDEM_WITH_MUJOCO
  engines.push_back(makeMujoco());
#endif
#ifdef TANDEM_WITH_ODE
  engines.push_back(makeOde());
#endif
#ifdef TANDEM_WITH_SIMBODY
  engines.push_back(makeSimbody());
#endif
  return engines;
}

void refuseBelts(const BenchScene& scene) {
  for (const BenchBody& body : scene.bodies)
    if (body.isBelt()) throw NotApplicable("belts are not built for this engine");
}

void refuseJoints(const BenchScene& scene) {
  if (!scene.joints.empty()) throw NotApplicable("joints are not built for this engine");
}

}  // namespace tandem::demos::bench
