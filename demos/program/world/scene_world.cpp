#include "world/scene_world.h"

#include <algorithm>
#include <optional>

#include "tandem/bullet_bridge/convert.h"

#include "world/rotation.h"
#include "world/scene_joint.h"

namespace tandem::demos {
namespace {

/// The scenario has a body here at first, in W.
btTransform computeStart(const BodyScenario& body, const SceneFrame& frame) {
  const Quat q_WB = frame.q_WS * makeRotation(body.rotation);
  return btTransform(toBullet(q_WB), toBullet(frame.toWorld(body.position)));
}

}  // namespace

SceneWorld::SceneWorld(const Scenario& scenario, const BodyPlaces& places)
    : frame_(makeSceneFrame(scenario)) {
  world_.setGravity(toBullet(frame_.toWorld(-scenario.gravity * Vec3::UnitZ())));
  for (const PlannedBody& plan : planBodies(scenario)) addBody(plan, scenario.friction, places);
  for (const JointScenario& joint : scenario.joints) addJoint(joint, 1.0 / scenario.host_rate);
}

SceneWorld::~SceneWorld() {
  for (const auto& joint : joints_) world_.removeConstraint(joint.get());
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
}

void SceneWorld::addBody(const PlannedBody& plan, double friction, const BodyPlaces& places) {
  const BodyScenario& body = plan.body;
  btCollisionShape& shape = shapes_.make(body);
  const auto mass = static_cast<btScalar>(body.mass);
  btVector3 inertia(0, 0, 0);
  if (body.inertia)
    inertia = toBullet(*body.inertia);
  else if (body.mass > 0.0)
    shape.calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
  info.m_friction = static_cast<btScalar>(body.friction.value_or(friction));
  info.m_restitution = static_cast<btScalar>(body.restitution);
  info.m_startWorldTransform = computeStart(body, frame_);
  if (const auto place = places.find(body.name); place != places.end())
    info.m_startWorldTransform =
        btTransform(toBullet(place->second.q_WB), toBullet(place->second.p_W));
  bodies_.push_back(std::make_unique<btRigidBody>(info));
  world_.addRigidBody(bodies_.back().get());
  placed_.push_back({plan, bodies_.back().get()});
}

void SceneWorld::addJoint(const JointScenario& joint, double host_step) {
  const auto find = [&](const std::string& name) {
    const auto placed = std::ranges::find_if(
        placed_, [&](const PlacedBody& one) { return one.plan.body.name == name; });
    return JointEnd{placed->body, computeStart(placed->plan.body, frame_)};
  };
  const Quat turn = Quat::FromTwoVectors(Vec3::UnitZ(), joint.axis);
  const btTransform at(toBullet(Quat(frame_.q_WS * turn)), toBullet(frame_.toWorld(joint.at)));
  const JointEnd first = find(joint.bodies[0]);
  std::optional<JointEnd> second;
  if (joint.bodies.size() == 2) second = find(joint.bodies[1]);
  joints_.push_back(makeJoint(joint, at, first, second ? &*second : nullptr, host_step));
  world_.addConstraint(joints_.back().get(), true);
}

SceneBody describeBody(const PlacedBody& placed) {
  SceneBody described;
  described.name = placed.plan.body.name;
  described.role = placed.plan.role;
  described.colour = placed.plan.body.colour;
  described.body = placed.body;
  described.is_static = placed.plan.body.mass == 0.0;
  const btCollisionShape& shape = *placed.body->getCollisionShape();
  described.is_box = shape.getShapeType() != SPHERE_SHAPE_PROXYTYPE;
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  const Vec3 half = 0.5 * fromBullet(high - low);
  if (described.is_box)
    described.half_extents = half;
  else
    described.radius = half.x();
  return described;
}

}  // namespace tandem::demos
