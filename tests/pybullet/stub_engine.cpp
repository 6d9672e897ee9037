#include "stub_engine.h"

#include <algorithm>

#include "stub_contacts.h"

namespace tandem::test {
namespace {

// v' = -d v, and Euler's equation at the start of the step, as in btMultiBody.
void damp(StubBody& body, double dt) {
  body.state.v_W -= dt * body.linear_damping * body.state.v_W;
  body.state.w_W -= dt * body.angular_damping * body.state.w_W;
}

void turnFreely(StubBody& body, double dt) {
  const Vec3 w = body.state.q_WB.conjugate() * body.state.w_W;
  const Vec3 torque = w.cross(Vec3(body.inertia.cwiseProduct(w)));
  body.state.w_W = body.state.q_WB * Vec3(w - dt * torque.cwiseQuotient(body.inertia));
}

// btMultiBody's default.
void limit(RigidState& state) {
  constexpr double kMost = 100.0;  // [m/s, rad/s]
  for (Vec3* velocity : {&state.v_W, &state.w_W})
    *velocity = velocity->cwiseMax(-kMost).cwiseMin(kMost);
}

void turn(RigidState& state, double dt) {
  const double angle = state.w_W.norm() * dt;
  if (angle == 0.0) return;
  const Eigen::AngleAxisd by(angle, state.w_W.normalized());
  state.q_WB = (Quat(by) * state.q_WB).normalized();
}

}  // namespace

int StubEngine::add(const StubBody& body) {
  int number = 0;
  while (bodies.count(number) > 0) ++number;
  StubBody& added = bodies[number] = body;
  added.serial = ++last_serial_;
  for (b3::CollisionShapeData& piece : added.shape) piece.body = number;
  return number;
}

void StubEngine::accelerate(StubBody& body, double dt) const {
  if (body.mass == 0.0) return;
  damp(body, dt);
  if (body.is_multibody || !contacts) turnFreely(body, dt);
  body.state.v_W += dt * gravity + body.hit / body.mass;
  body.hit.setZero();
  if (body.is_multibody) limit(body.state);
}

void StubEngine::move(StubBody& body, double dt) const {
  if (body.mass == 0.0) return;
  const double moved = moves_for > 0.0 ? moves_for : dt;
  body.state.p_W += moved * body.state.v_W;
  turn(body.state, moved);
}

void StubEngine::moveAll(double dt) {
  if (contacts) return contacts->move(bodies, without_contact, dt);
  for (auto& [number, body] : bodies) move(body, dt);
}

void StubEngine::step(Tick pre_tick, Tick post_tick, void* user_pointer) {
  const int count = std::max(substeps, 1);
  const double dt = time_step / count;
  for (int i = 0; i < count; ++i) {
    b3::PluginContext context{};
    context.client = client();
    context.user_pointer = user_pointer;
    if (pre_tick) pre_tick(&context);
    for (auto& [number, body] : bodies) accelerate(body, dt);
    if (!is_deformable) moveAll(dt);
    b3::PluginContext after{};
    after.client = client();
    after.user_pointer = user_pointer;
    if (post_tick) post_tick(&after);
    if (is_deformable) moveAll(dt);
  }
}

b3::CollisionShapeData makeStubShape(int geometry, const Vec3& dimensions) {
  b3::CollisionShapeData shape{};
  shape.link = -1;
  shape.geometry = geometry;
  std::copy_n(dimensions.data(), 3, shape.dimensions);
  shape.frame[6] = 1.0;
  return shape;
}

StubBody makeStubCube() {
  StubBody cube;
  cube.shape = {makeStubShape(b3::kBox, Vec3::Constant(0.04))};
  return cube;
}

StubBody makeStubFloor() {
  StubBody floor;
  floor.mass = 0.0;
  floor.inertia.setZero();
  floor.shape = {makeStubShape(b3::kPlane, Vec3::UnitZ())};
  return floor;
}

}  // namespace tandem::test
