// The way of a host without a plugin that gives the hand a world of its own. The host's world keeps
// its rate. A second, small Bullet world holds all bodies near the hand, which are all bodies of
// these scenes. It steps at the haptic rate, with coupler and contact as impulses. At the end of
// each host step its states replace those of the host's bodies.

#include <algorithm>

#include "bench/methods/all_methods.h"
#include "bench/methods/injected_scene.h"

namespace tandem::demos::bench {
namespace {

/// Gives `copy` the state that `body` had `ahead` seconds ago. In Bullet a body moves evenly
/// within a step, so this lies on its way.
void copyState(const btRigidBody& body, double ahead, btRigidBody& copy) {
  btTransform pose;
  btTransformUtil::integrateTransform(body.getCenterOfMassTransform(), body.getLinearVelocity(),
                                      body.getAngularVelocity(), static_cast<btScalar>(-ahead),
                                      pose);
  copy.setCenterOfMassTransform(pose);
  copy.setLinearVelocity(body.getLinearVelocity());
  copy.setAngularVelocity(body.getAngularVelocity());
}

class SmallWorld final : public Simulation {
 public:
  SmallWorld(const BenchScene& scene, int host_rate)
      : scene_(scene),
        host_step_(1.0 / host_rate),
        small_rate_(std::max(host_rate, kTargetRate)),
        host_(scene, {}),
        small_(scene, small_rate_) {}

  void step() override {
    host_.step(host_step_);
    ++steps_;
    const double now = steps_ * host_step_;
    while (smallTime() < now - 1e-9) {
      sampleTick();
      small_.step();
    }
    copyAll(smallTime() - now);
  }

  void read(SceneState& state) const override { host_.read(state); }
  void keepTicks() override { keeps_ticks_ = true; }
  std::vector<TickSample> tickSamples() const override { return samples_; }

 private:
  [[nodiscard]] double smallTime() const {
    return static_cast<double>(small_.stepCount()) / small_rate_;
  }

  void copyAll(double ahead) {
    for (std::size_t i = 0; i < scene_.tools.size(); ++i)
      copyState(small_.bullet().tool(i), ahead, host_.tool(i));
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b)
      if (!scene_.bodies[b].isStatic()) copyState(small_.bullet().body(b), ahead, host_.body(b));
  }

  void sampleTick() {
    const int steps_per_tick = small_rate_ / kTargetRate;
    if (!keeps_ticks_ || small_.stepCount() % steps_per_tick != 0) return;
    const auto tick = static_cast<std::uint64_t>(small_.stepCount() / steps_per_tick);
    for (std::size_t i = 0; i < scene_.tools.size(); ++i)
      samples_.push_back({tick, static_cast<int>(i), pointOf(small_.bullet().tool(i))});
  }

  const BenchScene& scene_;
  double host_step_;  // [s]
  int small_rate_;    // [Hz]
  int steps_ = 0;
  BulletScene host_;
  InjectedScene small_;
  bool keeps_ticks_ = false;
  std::vector<TickSample> samples_;
};

class SmallWorldMethod final : public Method {
 public:
  std::string name() const override { return "small Bullet world"; }
  bool isBulletAlone() const override { return true; }
  std::unique_ptr<Simulation> start(const BenchScene& scene, int host_rate) const override {
    return std::make_unique<SmallWorld>(scene, host_rate);
  }
};

}  // namespace

std::unique_ptr<Method> makeSmallWorld() { return std::make_unique<SmallWorldMethod>(); }

}  // namespace tandem::demos::bench
