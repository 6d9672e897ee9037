#pragma once

#include "bench/methods/bullet_scene.h"

namespace tandem::demos::bench {

/// A scene in Bullet whose couplers and tool contacts are forces from the states at the beginning
/// of a step. Bullet's step is then semi-implicit Euler. They are given in the pre-tick as impulses
/// F dt. Bullet's friction rows ignore the torque of forces, and pressed boxes would creep.
class InjectedScene {
 public:
  InjectedScene(const BenchScene& scene, int rate);

  /// Advances by 1/rate s.
  void step();

  [[nodiscard]] BulletScene& bullet() { return bullet_; }
  [[nodiscard]] const BulletScene& bullet() const { return bullet_; }
  [[nodiscard]] int stepCount() const { return steps_; }

 private:
  void applyImpulses();
  /// Contact force of body `b` on tool `i`; applies the reaction to the body.
  Vec3 push(std::size_t i, std::size_t b);

  const BenchScene& scene_;
  BulletScene bullet_;
  double step_;  // [s]
  int steps_ = 0;
  SceneState state_;
};

}  // namespace tandem::demos::bench
