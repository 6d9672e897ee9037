#include "bench/speed/speed_world.h"

#include <cmath>

#include "tandem/bullet_bridge/convert.h"

namespace tandem::demos::bench {
namespace {

constexpr double kEdge = 2.0 * kSpeedHalfEdge;
constexpr double kCrowdPitch = 0.2, kCubePitch = 0.2;  // [m]
constexpr double kPushSpeed = 0.05;                    // speed of the hand into the row [m/s]
constexpr double kFloating = 0.2;                      // height of a floating cube [m]
constexpr double kPi = 3.14159265358979323846;

/// Places bodies in a square, row by row, from its corner.
Vec3 placeInSquare(int index, int count, double pitch) {
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  return Vec3(pitch * (index % side), pitch * (index / side), kSpeedHalfEdge);
}

void switchGravityOff(btRigidBody& body) {
  body.setFlags(body.getFlags() | BT_DISABLE_WORLD_GRAVITY);
  body.setGravity(btVector3(0, 0, 0));
}

/// Height of hand and remote user.
double heightOf(const SpeedScene& scene) {
  return scene.touch == SpeedTouch::kCube ? kFloating : kSpeedHalfEdge;
}

}  // namespace

SpeedWorld::SpeedWorld(const SpeedScene& scene, double shared_mass_factor) {
  world_.setGravity(btVector3(0, 0, btScalar(-9.81)));
  addBody(floor_shape_, 0.0, Vec3::Zero());
  const auto let = [](btRigidBody& body, bool awake) {
    body.forceActivationState(awake ? DISABLE_DEACTIVATION : ISLAND_SLEEPING);
  };
  for (int i = 0; i < scene.bodies; ++i)
    let(addBody(box_shape_, kSpeedMass,
                Vec3(1.0, 1.0, 0.0) + placeInSquare(i, scene.bodies, kCrowdPitch)),
        scene.awake);
  for (int i = 0; i < scene.objects; ++i) {
    const Vec3 p_W = placeInSquare(i, scene.objects, kCubePitch);
    cubes_.push_back(
        &addBody(box_shape_, shared_mass_factor * kSpeedMass, Vec3(-p_W.x(), -p_W.y(), p_W.z())));
    let(*cubes_.back(), i == 0 && scene.touch != SpeedTouch::kNothing);
  }
  for (int i = 1; i <= 3 && scene.touch == SpeedTouch::kRow; ++i)
    let(addBody(box_shape_, kSpeedMass, Vec3((kEdge + 1e-3) * i, 0.0, kSpeedHalfEdge)), true);
  // All worlds of a scene begin alike: awake bodies have settled.
  for (int i = 0; i < 60; ++i) step(1.0 / 240.0);
}

SpeedWorld::~SpeedWorld() {
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
}

btRigidBody& SpeedWorld::addBody(btCollisionShape& shape, double mass, const Vec3& p_W) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0.0) shape.calculateLocalInertia(static_cast<btScalar>(mass), inertia);
  bodies_.push_back(
      std::make_unique<btRigidBody>(static_cast<btScalar>(mass), nullptr, &shape, inertia));
  bodies_.back()->setCenterOfMassTransform(toBullet(p_W, Quat::Identity()));
  world_.addRigidBody(bodies_.back().get());
  return *bodies_.back();
}

btRigidBody& SpeedWorld::addProxy(const Vec3& p_W, bool awake) {
  btRigidBody& proxy = addBody(sphere_shape_, kSpeedMass, p_W);
  switchGravityOff(proxy);
  proxy.forceActivationState(awake ? DISABLE_DEACTIVATION : ISLAND_SLEEPING);
  return proxy;
}

PointState handAt(const SpeedScene& scene, double time) {
  const double touch = kSpeedHalfEdge + kSpeedRadius;
  if (scene.touch == SpeedTouch::kNothing) return {Vec3(-touch, 0.0, 0.3), Vec3::Zero()};
  if (scene.touch == SpeedTouch::kRow)
    return {Vec3(-touch + kPushSpeed * time, 0.003, heightOf(scene)), Vec3(kPushSpeed, 0.0, 0.0)};
  // 2 mm into the cube, and half a millimetre to and fro.
  const double w = 2.0 * kPi, way = 0.5e-3;
  return {Vec3(-touch + 2e-3 - way * std::cos(w * time), 0.003, heightOf(scene)),
          Vec3(way * w * std::sin(w * time), 0.0, 0.0)};
}

PointState remoteAt(const SpeedScene& scene, double time) {
  const double touch = kSpeedHalfEdge + kSpeedRadius;
  if (!isPressed(scene)) return {Vec3(touch, 0.0, 0.3), Vec3::Zero()};
  const double w = 2.0 * kPi * 0.7, way = 2e-3;
  return {Vec3(touch - 0.03 + way * std::cos(w * time), -0.002, heightOf(scene)),
          Vec3(-way * w * std::sin(w * time), 0.0, 0.0)};
}

}  // namespace tandem::demos::bench
