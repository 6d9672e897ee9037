#include "bench/methods/all_methods.h"
#include "bench/methods/injected_scene.h"

namespace tandem::demos::bench {
namespace {

/// The method of hosts without a plugin: coupler and contact as impulses at the host's own rate.
class ForceInjection final : public Simulation {
 public:
  ForceInjection(const BenchScene& scene, int host_rate) : world_(scene, host_rate) {}
  void step() override { world_.step(); }
  void read(SceneState& state) const override { world_.bullet().read(state); }

 private:
  InjectedScene world_;
};

class ForceInjectionMethod final : public Method {
 public:
  std::string name() const override { return "force injection"; }
  bool isBulletAlone() const override { return true; }
  std::unique_ptr<Simulation> start(const BenchScene& scene, int host_rate) const override {
    return std::make_unique<ForceInjection>(scene, host_rate);
  }
};

}  // namespace

std::unique_ptr<Method> makeForceInjection() { return std::make_unique<ForceInjectionMethod>(); }

}  // namespace tandem::demos::bench
