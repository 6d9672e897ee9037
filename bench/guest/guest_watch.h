#pragma once

#include <algorithm>

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

namespace tandem::demos::bench {

/// Shows hooks of a Bullet world that a site must restore, and the work of its solver.
class GuestWatch {
 public:
  virtual ~GuestWatch() = default;
  [[nodiscard]] virtual btInternalTickCallback preTick() const = 0;
  [[nodiscard]] virtual btInternalTickCallback postTick() const = 0;
  /// Time that the next stepSimulation() call simulates [s].
  [[nodiscard]] virtual double foresee(double frame, int most, double fixed) const = 0;
  [[nodiscard]] virtual const btSimulationIslandManager* islands() const = 0;
  /// Sweeps of its solver in all steps.
  [[nodiscard]] virtual int sweeps() const = 0;
};

/// A Bullet world of a kind that shows all that.
template <typename World>
class WatchedWorld final : public World, public GuestWatch {
 public:
  using World::World;
  [[nodiscard]] btInternalTickCallback preTick() const override {
    return this->m_internalPreTickCallback;
  }
  [[nodiscard]] btInternalTickCallback postTick() const override {
    return this->m_internalTickCallback;
  }
  [[nodiscard]] double foresee(double frame, int most, double fixed) const override {
    const auto steps = static_cast<int>((static_cast<double>(this->m_localTime) + frame) / fixed);
    return most > 0 ? fixed * std::min(steps, most) : frame;
  }
  [[nodiscard]] const btSimulationIslandManager* islands() const override {
    return this->m_islandManager;
  }
  [[nodiscard]] int sweeps() const override { return sweeps_; }

 protected:
  void solveConstraints(btContactSolverInfo& info) override {
    sweeps_ += info.m_numIterations;
    World::solveConstraints(info);
  }

 private:
  int sweeps_ = 0;
};

}  // namespace tandem::demos::bench
