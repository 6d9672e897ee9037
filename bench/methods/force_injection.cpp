#include "tandem/bullet_bridge/convert.h"

#include "bench/methods/all_methods.h"
#include "bench/methods/bullet_scene.h"
#include "bench/scenes/touch_geometry.h"

namespace tandem::demos::bench {
namespace {

/// The method of hosts without a plugin: forces from the states at the beginning of a step, so
/// Bullet's step is semi-implicit Euler. They are given in the pre-tick as impulses F dt. Bullet's
/// friction rows ignore the torque of forces, and pressed boxes would creep.
class ForceInjection final : public Simulation {
 public:
  ForceInjection(const BenchScene& scene, int host_rate)
      : scene_(scene), bullet_(scene, {}), step_(1.0 / host_rate), state_(startState(scene)) {
    bullet_.world().setInternalTickCallback(
        [](btDynamicsWorld* world, btScalar) {
          static_cast<ForceInjection*>(world->getWorldUserInfo())->applyImpulses();
        },
        this, true);
  }

  void step() override {
    bullet_.world().stepSimulation(static_cast<btScalar>(step_), 0);
    ++steps_;
  }
  void read(SceneState& state) const override { bullet_.read(state); }

 private:
  void applyImpulses() {
    bullet_.read(state_);
    const double now = steps_ * step_;
    for (std::size_t i = 0; i < scene_.tools.size(); ++i) {
      const BenchTool& tool = scene_.tools[i];
      const PointState& at = state_.tools[i];
      Vec3 f_W = tool.f_W;
      if (const auto target = heldTarget(tool, now))
        f_W += computeCouplerForce(scene_.coupler, *target, at);
      for (std::size_t b = 0; b < scene_.bodies.size(); ++b) f_W += push(i, b);
      bullet_.tool(i).applyCentralImpulse(toBullet(Vec3(step_ * f_W)));
    }
  }

  /// Contact force of body `b` on tool `i`; applies the reaction to the body.
  Vec3 push(std::size_t i, std::size_t b) {
    const PointState& tool = state_.tools[i];
    const RigidState& body = state_.bodies[b];
    const Touch touch = computeTouch(scene_.bodies[b], body, tool.p_W, scene_.tools[i].radius);
    const Vec3 f_W = computeTouchForce(scene_.contact, touch, tool, body);
    if (!scene_.bodies[b].isStatic())
      bullet_.body(b).applyImpulse(toBullet(Vec3(-step_ * f_W)),
                                   toBullet(Vec3(touch.p_W - body.p_W)));
    return f_W;
  }

  const BenchScene& scene_;
  BulletScene bullet_;
  double step_;
  double steps_ = 0;
  SceneState state_;
};

class ForceInjectionMethod final : public Method {
 public:
  std::string name() const override { return "force injection"; }
  std::unique_ptr<Simulation> start(const BenchScene& scene, int host_rate) const override {
    return std::make_unique<ForceInjection>(scene, host_rate);
  }
};

}  // namespace

std::unique_ptr<Method> makeForceInjection() { return std::make_unique<ForceInjectionMethod>(); }

}  // namespace tandem::demos::bench
