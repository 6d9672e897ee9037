#include "bench/methods/bullet_scene.h"

#include <cmath>

#include "tandem/bullet_bridge/convert.h"

namespace tandem::demos::bench {
namespace {

constexpr int kToolGroup = btBroadphaseProxy::CharacterFilter;

std::unique_ptr<btCollisionShape> makeShape(const BenchBody& body) {
  if (const auto* box = std::get_if<BoxShape>(&body.shape))
    return std::make_unique<btBoxShape>(toBullet(box->half_extents));
  if (const auto* sphere = std::get_if<SphereShape>(&body.shape))
    return std::make_unique<btSphereShape>(static_cast<btScalar>(sphere->radius));
  const Vec3& normal_W = std::get<PlaneShape>(body.shape).normal_W;
  return std::make_unique<btStaticPlaneShape>(toBullet(normal_W), btScalar(0));
}

}  // namespace

BulletScene::BulletScene(const BenchScene& scene, const BulletSceneOptions& options)
    : scene_(scene) {
  world_.setGravity(toBullet(scene.gravity_W));
  const double friction = std::sqrt(scene.friction);
  for (const BenchBody& body : scene.bodies) {
    const double factor = body.is_shared ? options.shared_mass_factor : 1.0;
    const int group =
        body.isStatic() ? btBroadphaseProxy::StaticFilter : btBroadphaseProxy::DefaultFilter;
    int mask = btBroadphaseProxy::AllFilter;
    if (body.isStatic()) mask ^= btBroadphaseProxy::StaticFilter;
    if (options.has_tools && !options.tools_touch) mask &= ~kToolGroup;
    add(bodies_, makeShape(body), factor * body.mass, factor * computeInertia(body), body.start,
        friction, group, mask);
    if (body.isBelt()) bodies_.back()->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    if (!options.keeps_plane) continue;
    bodies_.back()->setLinearFactor(btVector3(1, 0, 1));
    bodies_.back()->setAngularFactor(btVector3(0, 1, 0));
  }
  joints_ = std::make_unique<BulletJoints>(scene, world_, bodies_);
  if (!options.has_tools) return;
  const int mask = options.tools_touch ? btBroadphaseProxy::AllFilter ^ kToolGroup : 0;
  for (const BenchTool& tool : scene.tools) {
    RigidState start;
    start.p_W = tool.start.p_W;
    start.v_W = tool.start.v_W;
    // A tool does not rotate: no inertia, no torque.
    btRigidBody& body =
        add(tools_, std::make_unique<btSphereShape>(static_cast<btScalar>(tool.radius)), tool.mass,
            Vec3::Zero(), start, 0.0, kToolGroup, mask);
    body.setGravity(btVector3(0, 0, 0));
    body.setFlags(body.getFlags() | BT_DISABLE_WORLD_GRAVITY);
  }
}

BulletScene::~BulletScene() {
  joints_.reset();
  for (const auto* list : {&tools_, &bodies_})
    for (const auto& body : *list) world_.removeRigidBody(body.get());
}

btRigidBody& BulletScene::add(std::vector<std::unique_ptr<btRigidBody>>& list,
                              std::unique_ptr<btCollisionShape> shape, double mass,
                              const Vec3& inertia, const RigidState& start, double friction,
                              int group, int mask) {
  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, shape.get(),
                                                toBullet(inertia));
  info.m_friction = static_cast<btScalar>(friction);
  info.m_startWorldTransform = toBullet(start.p_W, start.q_WB);
  list.push_back(std::make_unique<btRigidBody>(info));
  btRigidBody& body = *list.back();
  body.setLinearVelocity(toBullet(start.v_W));
  body.setAngularVelocity(toBullet(start.w_W));
  body.setActivationState(DISABLE_DEACTIVATION);
  world_.addRigidBody(&body, group, mask);
  shapes_.push_back(std::move(shape));
  return body;
}

void BulletScene::step(double h) {
  time_ += h;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const BenchBody& body = scene_.bodies[b];
    if (!body.isBelt()) continue;
    // Bullet takes a kinematic body's velocity from its way since the last step.
    const Vec3 p_W = body.start.p_W + time_ * body.start.v_W;
    bodies_[b]->setCenterOfMassTransform(toBullet(p_W, body.start.q_WB));
  }
  joints_->setStep(h);
  world_.stepSimulation(static_cast<btScalar>(h), 0);
}

void BulletScene::read(SceneState& state) const {
  for (std::size_t i = 0; i < tools_.size(); ++i) state.tools[i] = pointOf(*tools_[i]);
  for (std::size_t i = 0; i < bodies_.size(); ++i) state.bodies[i] = stateOf(*bodies_[i]);
}

PointState pointOf(const btRigidBody& body) {
  return {fromBullet(body.getCenterOfMassPosition()), fromBullet(body.getLinearVelocity())};
}

RigidState stateOf(const btRigidBody& body) {
  RigidState state;
  state.p_W = fromBullet(body.getCenterOfMassPosition());
  state.q_WB = fromBullet(body.getOrientation());
  state.v_W = fromBullet(body.getLinearVelocity());
  state.w_W = fromBullet(body.getAngularVelocity());
  return state;
}

}  // namespace tandem::demos::bench
