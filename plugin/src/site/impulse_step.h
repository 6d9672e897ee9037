#pragma once

#include <vector>

#include "coordination/src/island/wrench.h"
#include "site/island_step.h"

namespace tandem {

/// Bullet moves the bodies, with impulses of the forces at each tick's start. The host steps at the
/// haptic rate. For comparison, and for worlds where everything runs at 1 kHz.
class ImpulseStep final : public IslandStep {
 public:
  using IslandStep::IslandStep;

  void checkObject(double mass) const override;
  void addProxy(Peer& peer, const Vec3& start_W) override;
  void finishSetUp() override;
  void makeUp(double, double) noexcept override {}
  void advance(double now, double end) noexcept override;
  void showProxy(Peer& peer) noexcept override;
  void before(double dt) noexcept override;
  void after(double dt) noexcept override;

 private:
  void checkStable(const char* what, double mass) const;

  std::vector<Wrench> wrenches_;  ///< by body, for the next host step
};

}  // namespace tandem
