#include "bench/methods/injected_scene.h"

#include "tandem/bullet_bridge/convert.h"

#include "bench/scenes/touch_geometry.h"

namespace tandem::demos::bench {

InjectedScene::InjectedScene(const BenchScene& scene, int rate)
    : scene_(scene), bullet_(scene, {}), step_(1.0 / rate), state_(startState(scene)) {
  bullet_.world().setInternalTickCallback(
      [](btDynamicsWorld* world, btScalar) {
        static_cast<InjectedScene*>(world->getWorldUserInfo())->applyImpulses();
      },
      this, true);
}

void InjectedScene::step() {
  bullet_.step(step_);
  ++steps_;
}

void InjectedScene::applyImpulses() {
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

Vec3 InjectedScene::push(std::size_t i, std::size_t b) {
  const PointState& tool = state_.tools[i];
  const RigidState& body = state_.bodies[b];
  const Touch touch = computeTouch(scene_.bodies[b], body, tool.p_W, scene_.tools[i].radius);
  const Vec3 f_W = computeTouchForce(scene_.contact, touch, tool, body);
  if (!scene_.bodies[b].isStatic())
    bullet_.body(b).applyImpulse(toBullet(Vec3(-step_ * f_W)),
                                 toBullet(Vec3(touch.p_W - body.p_W)));
  return f_W;
}

}  // namespace tandem::demos::bench
