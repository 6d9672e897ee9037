#pragma once

#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "bench/scenes/bench_scene.h"

namespace tandem::demos::bench {

/// A scene's joints as Bullet's hinges and sliders, in a world for as long as this lives.
class BulletJoints {
 public:
  /// `bodies` are those of the scene, in its order. World and bodies must outlive this.
  BulletJoints(const BenchScene& scene, btDynamicsWorld& world,
               const std::vector<std::unique_ptr<btRigidBody>>& bodies);
  ~BulletJoints();
  BulletJoints(const BulletJoints&) = delete;
  BulletJoints& operator=(const BulletJoints&) = delete;

  /// Call before each step of `h` [s]: Bullet bounds a hinge's motor by the impulse of a step.
  void setStep(double h);

 private:
  void addHinge(const BenchJoint& joint, btRigidBody& a, btRigidBody* b);
  void addSlider(const BenchJoint& joint, btRigidBody& a, btRigidBody* b);

  struct HingeMotor {
    btHingeConstraint* hinge;
    BenchJoint::Motor motor;
  };

  btDynamicsWorld& world_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<HingeMotor> motors_;
};

}  // namespace tandem::demos::bench
