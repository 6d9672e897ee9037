#include "island/touch.h"

#include <algorithm>

namespace tandem {
namespace {

SphereContact findPieceContact(const Vec3& p_W, double radius, const Obstacle& obstacle,
                               const Touch& touch) noexcept {
  const PlainRotation rotation(obstacle.q_WB);
  const PlainVec c_B = rotation.toBody(PlainVec(p_W) - PlainVec(obstacle.p_WB));
  const Mesh& mesh = *std::get_if<Mesh>(&obstacle.shape);
  const Separation found = separate(c_B, mesh, touch.piece, touch.touched);
  const Vec3 n_W = rotation.toWorld(found.n).toVec3();
  return {computeGap(found, radius), n_W, p_W - found.distance * n_W,
          found.aside > 0.0 ? -1 : found.face};
}

}  // namespace

TouchKey keyOf(const IslandModel& model, const Touch& touch) noexcept {
  if (!touch.obstacle) return {touch.sphere, touch.other, 0};
  const auto place = static_cast<std::uint64_t>(touch.obstacle - model.obstacles->data());
  return {touch.sphere, touch.other, touch.obstacle->id != 0 ? touch.obstacle->id : place + 1};
}

void addMemory(const IslandModel& model, Touch& touch, double ahead) noexcept {
  touch.allowance = model.memory.allowance(keyOf(model, touch), ahead);
}

bool couldMeet(const IslandModel& model, const Touch& touch, const States& states,
               double reach) noexcept {
  if (touch.touched >= 0) return true;
  const Vec3& p_W = touch.obstacle ? touch.obstacle->p_WB : states[touch.other].p_W;
  reach += model.bodies[touch.sphere].bounding_radius;
  reach += touch.obstacle ? computeBoundingRadius(touch.obstacle->shape)
                          : model.bodies[touch.other].bounding_radius;
  return !((states[touch.sphere].p_W - p_W).squaredNorm() > reach * reach);
}

TouchState computeTouchState(const IslandModel& model, const Touch& touch,
                             const States& states) noexcept {
  const RigidState& sphere = states[touch.sphere];
  const double radius = std::get<Sphere>(model.bodies[touch.sphere].settings.shape).radius;
  TouchState state;
  if (touch.obstacle) {
    const Obstacle& obstacle = *touch.obstacle;
    state.geometry = touch.piece < 0
                         ? findSphereContact(sphere.p_W, radius, obstacle.shape, obstacle.p_WB,
                                             obstacle.q_WB, touch.touched)
                         : findPieceContact(sphere.p_W, radius, obstacle, touch);
    state.overlap_rate = -state.geometry.n_W.dot(sphere.v_W);
    return state;
  }
  const RigidState& other = states[touch.other];
  state.geometry = findSphereContact(sphere.p_W, radius, model.bodies[touch.other].settings.shape,
                                     other.p_W, other.q_WB, touch.touched);
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
    Touch touch{sphere, other, obstacle, {}};
    recallFace(model, touch);
    if (!couldMeet(model, touch, states, 0.0)) return;
    if (isWholeMesh(touch)) {
      forEachPiece(model, touch, states, 0.0,
                   [&](const Touch&, double found) { gap = std::min(gap, found); });
    } else {
      gap = std::min(gap, computeTouchState(model, touch, states).geometry.gap);
    }
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
