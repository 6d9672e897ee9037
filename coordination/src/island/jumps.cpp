#include "island/jumps.h"

#include <algorithm>
#include <cmath>

#include "geometry/turn.h"

namespace tandem {
namespace {

/// Velocities explain a move of this time [s]. A received state may follow a gap; the host places
/// dynamic bodies, in impulse injection at each tick.
double explainedTime(const IslandModel& model, const ModelBody& body) noexcept {
  return body.settings.motion == Motion::kHeld ? 0.25 : 2.0 * model.settings.haptic_period;
}

/// Hosts move fixed objects in steps, without a velocity. One this long pushes at once [m].
constexpr double kStepOfFixed = 2e-3;

/// Distance between two states, with the farthest point that turns [m].
double computeWay(const ModelBody& body, const RigidState& next) noexcept {
  const double way = (next.p_W - body.state.p_W).norm();
  if (next.q_WB.coeffs() == body.state.q_WB.coeffs()) return way;
  const PlainVec turn = computeTurn(body.state.q_WB.coeffs().data(), next.q_WB.coeffs().data());
  return way + std::sqrt(dot(turn, turn)) * body.bounding_radius;
}

double computeSpeed(const ModelBody& body, const RigidState& state) noexcept {
  return state.v_W.norm() + state.w_W.norm() * body.bounding_radius;
}

/// Overlap of two bodies of a guided island, which keep their order [m].
double measureAlongGuide(const IslandModel& model, const Touch& touch,
                         const States& states) noexcept {
  const IslandBody& a = model.bodies[touch.sphere].settings;
  const IslandBody& b = model.bodies[touch.other].settings;
  Vec3 towards = *model.settings.guide;  // from the sphere to the other
  if (towards.dot(b.start.p_W - a.start.p_W) < 0.0) towards = -towards;
  return computeReach(a.shape, a.start.q_WB.conjugate() * towards) +
         computeReach(b.shape, b.start.q_WB.conjugate() * -towards) -
         towards.dot(states[touch.other].p_W - states[touch.sphere].p_W);
}

/// Depth of a contact, for a mesh at its deepest piece; 0 if there is none [m].
double measureDepth(const IslandModel& model, const Touch& touch, const States& states) noexcept {
  if (model.settings.guide) return std::max(0.0, measureAlongGuide(model, touch, states));
  if (!couldMeet(model, touch, states, 0.0)) return 0.0;
  if (!isWholeMesh(model, touch))
    return std::max(0.0, -computeTouchState(model, touch, states).geometry.gap);
  double depth = 0.0;
  forEachPiece(model, touch, states, 0.0,
               [&](const Touch&, double gap) { depth = std::max(depth, -gap); });
  return depth;
}

/// Depth of the sphere in an obstacle that moved, where that was before.
double measureDepthBefore(const IslandModel& model, const Touch& touch,
                          const States& states) noexcept {
  const Obstacle& obstacle = *touch.obstacle;
  const double radius = std::get<Sphere>(model.bodies[touch.sphere].settings.shape).radius;
  const ShapePose pose = poseOf(touch, obstacle.p_before_WB, obstacle.q_before_WB);
  const SphereContact before =
      findSphereContact(states[touch.sphere].p_W, radius, shapeOf(model, touch), pose.p_W, pose.q_W,
                        isWholeMesh(model, touch) ? -1 : touch.touched);
  return std::max(0.0, -before.gap);
}

/// Copies the states of all bodies, which are listed then.
void copyStates(IslandModel& model, States& states) noexcept {
  if (!model.is_listed) model.listPresent();
  for (std::size_t b = 0; b < states.size(); ++b) states[b] = model.bodies[b].state;
}

/// Wakes the bodies that sleep in what has jumped.
void wakeTouched(IslandModel& model, States& states) noexcept {
  copyStates(model, states);
  for (const IslandContact& pair : model.contacts) {
    const ModelBody &a = model.bodies[pair.sphere], &b = model.bodies[pair.other];
    if (!a.has_jumped && !b.has_jumped) continue;
    if (measureDepth(model, {pair.sphere, pair.other, nullptr, {}}, states) == 0.0) continue;
    model.wake(pair.sphere);
    model.wake(pair.other);
  }
  if (!model.is_listed) model.listPresent();
}

void letIn(IslandModel& model, Touch touch, const States& states) noexcept {
  const bool has_moved =
      model.has_arrivals && touch.obstacle && touch.obstacle->change != ObstacleChange::kNone;
  const bool has_jumped =
      model.bodies[touch.sphere].has_jumped || model.bodies[touch.other].has_jumped;
  if (!has_moved && !has_jumped) return;
  const TouchKey key = keyOf(model, touch);
  const bool is_new = has_jumped || touch.obstacle->change == ObstacleChange::kNew;
  const double before = is_new ? 0.0 : measureDepthBefore(model, touch, states);
  double depth = measureDepth(model, touch, states);
  if (touch.touched >= 0 && depth - before > kStepOfFixed) {
    // It was put elsewhere: the side that the sphere touched means nothing now.
    model.faces.forget(key);
    touch.touched = -1;
    depth = measureDepth(model, touch, states);
  }
  if (depth == 0.0) return;
  if (is_new) return model.memory.letIn(key, depth);
  model.memory.keepDepth(key, before);
  model.memory.letIn(key, depth, kStepOfFixed);
}

}  // namespace

void noteJump(IslandModel& model, BodyIndex b, States& states) noexcept {
  copyStates(model, states);
  forEachTouch(model, [&](const Touch& touch) {
    if (touch.sphere != b && touch.other != b) return;
    if (const double depth = measureDepth(model, touch, states); depth > 0.0)
      model.memory.keepDepth(keyOf(model, touch), depth);
  });
  model.faces.forget(b);
  model.bodies[b].has_jumped = true;
  model.has_jumps = model.remembers_touches;
}

void notePlacing(IslandModel& model, BodyIndex b, const RigidState& next, States& states) noexcept {
  const ModelBody& body = model.bodies[b];
  const double speed = std::max(computeSpeed(body, body.state), computeSpeed(body, next));
  const double explained = TouchMemory::kNoticed + explainedTime(model, body) * speed;
  if (computeWay(body, next) > explained) noteJump(model, b, states);
}

void letJumpsIn(IslandModel& model, States& states) noexcept {
  wakeTouched(model, states);
  forEachTouch(model, [&](const Touch& touch) { letIn(model, touch, states); });
  if (model.obstacles) model.has_arrivals = false;
}

void endJumps(IslandModel& model, double dt, States& states) noexcept {
  if (model.has_jumps)
    for (ModelBody& body : model.bodies) body.has_jumped = false;
  model.has_jumps = false;
  copyStates(model, states);
  model.memory.age(dt, [&](const TouchKey& key) {
    double depth = 0.0;
    forEachTouch(model, [&](const Touch& touch) {
      if (keyOf(model, touch) == key) depth = measureDepth(model, touch, states);
    });
    return depth;
  });
}

}  // namespace tandem
