#include "island/touch.h"

#include <algorithm>

namespace tandem {
namespace {

SphereContact findPieceContact(const Vec3& p_W, double radius, const Mesh& mesh,
                               const ShapePose& pose, const Touch& touch) noexcept {
  const PlainRotation rotation(pose.q_W);
  const PlainVec c_B = rotation.toBody(PlainVec(p_W) - PlainVec(pose.p_W));
  const Separation found = separate(c_B, mesh, touch.piece, touch.touched);
  const Vec3 n_W = rotation.toWorld(found.n).toVec3();
  return {computeGap(found, radius), n_W, p_W - found.distance * n_W,
          found.aside > 0.0 ? -1 : found.face};
}

/// Number of the part in its compound, from 1; 0 without a part.
int numberOf(const IslandModel& model, const Touch& touch) noexcept {
  if (!touch.part) return 0;
  const Compound& whole = *std::get_if<Compound>(&wholeShapeOf(model, touch));
  return static_cast<int>(touch.part - whole.parts->all().data()) + 1;
}

}  // namespace

TouchKey keyOf(const IslandModel& model, const Touch& touch) noexcept {
  const int part = numberOf(model, touch);
  if (!touch.obstacle) return {touch.sphere, touch.other, 0, part};
  const auto place = static_cast<std::size_t>(touch.obstacle - model.obstacles->data());
  return {touch.sphere, touch.other, keyOf(*touch.obstacle, place), part};
}

void addMemory(const IslandModel& model, Touch& touch, double ahead) noexcept {
  touch.allowance = model.memory.allowance(keyOf(model, touch), ahead);
}

ShapePose poseOf(const Touch& touch, const Vec3& p_WB, const Quat& q_WB) noexcept {
  if (!touch.part) return {p_WB, q_WB};
  return {p_WB + q_WB * touch.part->p_BC, q_WB * touch.part->q_BC};
}

ShapePose poseOf(const Touch& touch, const States& states) noexcept {
  if (touch.obstacle) return poseOf(touch, touch.obstacle->p_WB, touch.obstacle->q_WB);
  return poseOf(touch, states[touch.other].p_W, states[touch.other].q_WB);
}

namespace {

[[gnu::noinline]] bool couldMeetPart(const IslandModel& model, const Touch& touch,
                                     const States& states, double reach) noexcept {
  const Vec3& p_W = touch.obstacle ? touch.obstacle->p_WB : states[touch.other].p_W;
  const Quat& q_WB = touch.obstacle ? touch.obstacle->q_WB : states[touch.other].q_WB;
  const Vec3 middle_W = p_W + q_WB * touch.part->middle_B;
  reach += model.bodies[touch.sphere].bounding_radius + touch.part->radius;
  return !((states[touch.sphere].p_W - middle_W).squaredNorm() > reach * reach);
}

/// Contact of a sphere with the other body or obstacle at this pose.
SphereContact findContact(const IslandModel& model, const Touch& touch, const Vec3& p_W,
                          const Vec3& p_WB, const Quat& q_WB) noexcept {
  const double radius = std::get<Sphere>(model.bodies[touch.sphere].settings.shape).radius;
  const auto find = [&](const Vec3& p_WC, const Quat& q_WC) {
    const Shape& shape = shapeOf(model, touch);
    if (touch.piece < 0) return findSphereContact(p_W, radius, shape, p_WC, q_WC, touch.touched);
    return findPieceContact(p_W, radius, *std::get_if<Mesh>(&shape), {p_WC, q_WC}, touch);
  };
  if (!touch.part) [[likely]]
    return find(p_WB, q_WB);
  const ShapePose pose = poseOf(touch, p_WB, q_WB);
  return find(pose.p_W, pose.q_W);
}

}  // namespace

bool couldMeet(const IslandModel& model, const Touch& touch, const States& states,
               double reach) noexcept {
  if (touch.touched >= 0) return true;
  if (touch.part) [[unlikely]]
    return couldMeetPart(model, touch, states, reach);
  const Vec3& p_W = touch.obstacle ? touch.obstacle->p_WB : states[touch.other].p_W;
  reach += model.bodies[touch.sphere].bounding_radius;
  reach += touch.obstacle ? computeBoundingRadius(touch.obstacle->shape)
                          : model.bodies[touch.other].bounding_radius;
  return !((states[touch.sphere].p_W - p_W).squaredNorm() > reach * reach);
}

TouchState computeTouchState(const IslandModel& model, const Touch& touch,
                             const States& states) noexcept {
  const RigidState& sphere = states[touch.sphere];
  TouchState state;
  if (touch.obstacle) {
    const Obstacle& obstacle = *touch.obstacle;
    state.geometry = findContact(model, touch, sphere.p_W, obstacle.p_WB, obstacle.q_WB);
    state.overlap_rate = -state.geometry.n_W.dot(sphere.v_W);
    return state;
  }
  const RigidState& other = states[touch.other];
  state.geometry = findContact(model, touch, sphere.p_W, other.p_W, other.q_WB);
  const Vec3 v_point_W = other.v_W + other.w_W.cross(state.geometry.p_W - other.p_W);
  state.overlap_rate = -state.geometry.n_W.dot(sphere.v_W - v_point_W);
  return state;
}

double computePush(const Touch& touch, const TouchState& state) noexcept {
  return computeContactForce(touch.gains, state.overlap() - touch.allowance, state.overlap_rate);
}

void addPush(const IslandModel& model, const Touch& touch, const TouchState& state, double push,
             const States& states, std::vector<Wrench>& wrenches) noexcept {
  // The line of force passes through the sphere's centre: no torque on the sphere.
  const Vec3 f_sphere_W = push * state.geometry.n_W;
  wrenches[touch.sphere].f_W += f_sphere_W;
  if (touch.obstacle) return;
  wrenches[touch.other].f_W -= f_sphere_W;
  if (model.bodies[touch.other].rotates())
    wrenches[touch.other].t_W -= (state.geometry.p_W - states[touch.other].p_W).cross(f_sphere_W);
}

double computeOverlap(const IslandModel& model, const States& states, BodyIndex body) noexcept {
  double gap = 0.0;
  const auto look = [&](BodyIndex sphere, BodyIndex other, const Obstacle* obstacle) {
    const auto measure = [&](const Touch& touch) {
      if (!couldMeet(model, touch, states, 0.0)) return;
      if (isWholeMesh(model, touch)) {
        forEachPiece(model, touch, states, 0.0,
                     [&](const Touch&, double found) { gap = std::min(gap, found); });
      } else {
        gap = std::min(gap, computeTouchState(model, touch, states).geometry.gap);
      }
    };
    Touch whole{sphere, other, obstacle, {}};
    if (hasParts(model, whole)) return forEachPart(model, whole, measure);
    recallFace(model, whole);
    measure(whole);
  };
  if (model.bodies[body].has_tool) return 0.0;
  const auto is_there = [&](BodyIndex b) { return model.bodies[b].isTouchable(); };
  for (const IslandContact& contact : model.contacts) {
    if (contact.sphere != body && contact.other != body) continue;
    const BodyIndex partner = contact.sphere == body ? contact.other : contact.sphere;
    if (is_there(partner) && model.letsMeet(body, partner) && !model.areJoined(body, partner))
      look(contact.sphere, contact.other, nullptr);
  }
  if (!model.bodies[body].settings.feels_obstacles) return -gap;
  for (const BodyIndex b : model.slots)
    if (is_there(b) && model.bodies[b].settings.touches_spheres && model.letsMeet(body, b))
      look(body, b, nullptr);
  if (!model.obstacles) return -gap;
  for (const Obstacle& obstacle : *model.obstacles)
    if (model.bodies[body].settings.filter.meets(obstacle.filter)) look(body, body, &obstacle);
  return -gap;
}

}  // namespace tandem
