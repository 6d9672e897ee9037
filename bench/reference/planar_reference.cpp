#include "bench/reference/planar_reference.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

#include "bench/reference/planar_solver.h"

namespace tandem::demos::bench {
namespace {

Vec2 toPlane(const BenchScene& scene, const Vec3& a) {
  if (a.y() != 0.0) throw std::invalid_argument(scene.name + ": motion leaves the x-z plane");
  return {a.x(), a.z()};
}

Vec3 toSpace(const Vec2& a) { return {a.x(), 0.0, a.y()}; }

PlanarBody makeBody(const BenchScene& scene, const BenchBody& body) {
  PlanarBody planar;
  planar.mass = body.mass;
  planar.inertia = computeInertia(body).y();
  planar.p = toPlane(scene, body.start.p_W);
  planar.v = toPlane(scene, body.start.v_W);
  // A counterclockwise turn from x to z is a turn about -y.
  planar.angle = -2.0 * std::atan2(body.start.q_WB.y(), body.start.q_WB.w());
  planar.w = -body.start.w_W.y();
  if (const auto* box = std::get_if<BoxShape>(&body.shape)) {
    planar.half = toPlane(scene, Vec3(box->half_extents.x(), 0.0, box->half_extents.z()));
  } else if (const auto* sphere = std::get_if<SphereShape>(&body.shape)) {
    planar.shape = PlanarShape::kCircle;
    planar.radius = sphere->radius;
  } else {
    planar.shape = PlanarShape::kHalfPlane;
    planar.normal = toPlane(scene, std::get<PlaneShape>(body.shape).normal_W);
  }
  return planar;
}

Vec2 toFrame(const PlanarBody& body, const Vec2& p) {
  return Eigen::Rotation2Dd(-body.angle) * (p - body.p);
}

PlanarJoint makeJoint(const BenchScene& scene, const BenchJoint& joint, const PlanarScene& planar) {
  const PlanarBody plane;
  const PlanarBody &a = planar.bodies[joint.a], &b = joint.b ? planar.bodies[*joint.b] : plane;
  const Vec2 pivot = toPlane(scene, joint.pivot_W);
  PlanarJoint made;
  made.is_slider = joint.kind == BenchJointKind::kSlider;
  made.a = joint.a;
  made.b = joint.b;
  made.at_a = toFrame(a, pivot);
  made.at_b = toFrame(b, pivot);
  made.axis = Eigen::Rotation2Dd(-b.angle) * toPlane(scene, joint.axis_W);
  made.turn = a.angle - b.angle;
  // A turn about y is clockwise.
  if (joint.limit)
    made.limit = made.is_slider ? PlanarJoint::Limit{joint.limit->low, joint.limit->high}
                                : PlanarJoint::Limit{-joint.limit->high, -joint.limit->low};
  if (joint.motor)
    made.motor = {made.is_slider ? joint.motor->speed : -joint.motor->speed, joint.motor->force};
  return made;
}

void setTargets(const BenchScene& scene, double t, PlanarScene& planar) {
  for (std::size_t i = 0; i < scene.tools.size(); ++i) {
    const auto target = heldTarget(scene.tools[i], t);
    planar.tools[i].is_held = target.has_value();
    if (!target) continue;
    planar.tools[i].target_p = toPlane(scene, target->p_W);
    planar.tools[i].target_v = toPlane(scene, target->v_W);
  }
}

void read(const PlanarScene& planar, SceneState& state) {
  for (std::size_t i = 0; i < planar.tools.size(); ++i)
    state.tools[i] = {toSpace(planar.tools[i].p), toSpace(planar.tools[i].v)};
  for (std::size_t b = 0; b < planar.bodies.size(); ++b) {
    const PlanarBody& body = planar.bodies[b];
    if (body.mass == 0.0) continue;
    state.bodies[b].p_W = toSpace(body.p);
    state.bodies[b].q_WB = Eigen::AngleAxisd(-body.angle, Vec3::UnitY());
    state.bodies[b].v_W = toSpace(body.v);
    state.bodies[b].w_W = {0.0, -body.w, 0.0};
  }
}

}  // namespace

PlanarScene makePlanarScene(const BenchScene& scene) {
  PlanarScene planar;
  planar.gravity = toPlane(scene, scene.gravity_W);
  planar.friction = scene.friction;
  planar.coupler_stiffness = scene.coupler.stiffness;
  planar.coupler_damping = scene.coupler.damping;
  planar.contact_stiffness = scene.contact.stiffness;
  planar.contact_damping = scene.contact.damping;
  for (const BenchBody& body : scene.bodies) planar.bodies.push_back(makeBody(scene, body));
  for (const BenchTool& tool : scene.tools) {
    PlanarTool circle;
    circle.radius = tool.radius;
    circle.mass = tool.mass;
    circle.p = toPlane(scene, tool.start.p_W);
    circle.v = toPlane(scene, tool.start.v_W);
    circle.force = toPlane(scene, tool.f_W);
    planar.tools.push_back(circle);
  }
  for (const BenchJoint& joint : scene.joints)
    planar.joints.push_back(makeJoint(scene, joint, planar));
  setTargets(scene, 0.0, planar);
  return planar;
}

ReferenceRun runPlanarReference(const BenchScene& scene, int rate) {
  if (rate % kGridRate != 0)
    throw std::invalid_argument("the rate must be a multiple of the grid's");
  PlanarSolver solver(makePlanarScene(scene));
  ReferenceRun run;
  SceneState state = startState(scene);
  const auto count = static_cast<std::size_t>(std::llround(scene.duration * kGridRate));
  run.states.reserve(count + 1);
  run.states.push_back(state);
  for (std::size_t n = 0; n < count; ++n) {
    // Targets change at grid times only.
    setTargets(scene, static_cast<double>(n) / kGridRate, solver.scene());
    for (int i = 0; i < rate / kGridRate; ++i) solver.step(1.0 / rate);
    read(solver.scene(), state);
    run.states.push_back(state);
  }
  return run;
}

}  // namespace tandem::demos::bench
