// The C functions of a physics server that the plugin calls, in front of a StubEngine. The program
// exports them, as PyBullet's module does.

#include <algorithm>

#include "stub_engine.h"

using tandem::Quat;
using tandem::RigidState;
using tandem::Vec3;
using tandem::test::StubBody;
using tandem::test::StubEngine;
namespace b3 = tandem::pybullet::b3;

namespace {

enum class Kind { kNone, kState, kPose, kDynamics, kChange, kParameters, kShape, kFilter };

/// Like PyBullet's: one command and one status per process are enough for a client that waits.
struct Order {
  Kind kind = Kind::kNone;
  StubEngine* engine = nullptr;
  int body = -1;
  int other = -1;
  bool has_position = false, has_orientation = false, has_velocity = false, has_spin = false;
  bool has_mass = false, has_inertia = false, has_linear = false, has_angular = false;
  bool has_friction = false, has_restitution = false, has_threshold = false;
  RigidState state;
  double mass = 0.0, linear = 0.0, angular = 0.0, friction = 0.0, restitution = 0.0;
  double threshold = 0.0;
  Vec3 inertia{0, 0, 0};
  int activation = 0;
  bool collides = true;
};

struct Answer {
  Kind kind = Kind::kNone;  // kNone: failed
  const StubBody* body = nullptr;
  StubEngine* engine = nullptr;
  double q[7], u[6];
};

Order order;
Answer answer;
std::vector<b3::CollisionShapeData> cached_shape;

b3::Command begin(b3::Client client, Kind kind, int body) {
  order = Order{};
  order.kind = kind;
  order.engine = reinterpret_cast<StubEngine*>(client);
  order.body = body;
  return reinterpret_cast<b3::Command>(&order);
}

Order& toOrder(b3::Command command) { return *reinterpret_cast<Order*>(command); }
Answer& toAnswer(b3::Status status) { return *reinterpret_cast<Answer*>(status); }

void pose(StubBody& body, const Order& by) {
  if (by.has_position) body.state.p_W = by.state.p_W;
  if (by.has_orientation) body.state.q_WB = by.state.q_WB;
  if (by.has_velocity || by.has_position) body.state.v_W = by.state.v_W;
  if (by.has_spin || by.has_orientation) body.state.w_W = by.state.w_W;
}

void change(StubBody& body, const Order& by) {
  if (by.has_mass) {
    body.mass = by.mass;
    // PyBullet then uses the inertia of the shape. The plugin must correct that.
    body.inertia.setConstant(123.0 * by.mass);
  }
  if (by.has_inertia) body.inertia = by.inertia;
  if (by.has_linear) body.linear_damping = by.linear;
  if (by.has_angular) body.angular_damping = by.angular;
  if (by.has_friction) body.friction = by.friction;
  if (by.has_restitution) body.restitution = by.restitution;
  if (by.has_threshold) body.contact_threshold = by.threshold;
  if (by.activation & b3::kEnableSleeping) body.may_sleep = true;
  if (by.activation & b3::kDisableSleeping) body.may_sleep = false;
}

void tellState(const StubBody& body) {
  std::copy_n(body.state.p_W.data(), 3, answer.q);
  std::copy_n(body.state.q_WB.coeffs().data(), 4, answer.q + 3);
  std::copy_n(body.state.v_W.data(), 3, answer.u);
  std::copy_n(body.state.w_W.data(), 3, answer.u + 3);
}

bool carryOut(const Order& by) {
  StubEngine& engine = *by.engine;
  if (by.kind == Kind::kParameters) return true;
  if (by.kind == Kind::kFilter) {
    const std::pair<int, int> pair = std::minmax(by.body, by.other);
    if (by.collides) {
      engine.without_contact.erase(pair);
    } else {
      engine.without_contact.insert(pair);
    }
    return true;
  }
  const auto found = engine.bodies.find(by.body);
  if (found == engine.bodies.end()) return false;
  StubBody& body = found->second;
  answer.body = &body;
  if (by.kind == Kind::kState) tellState(body);
  if (by.kind == Kind::kPose) pose(body, by);
  if (by.kind == Kind::kChange) change(body, by);
  if (by.kind == Kind::kShape) {
    if (!body.is_multibody) return false;  // keeps the cached shape
    cached_shape = body.shape;
  }
  return true;
}

}  // namespace

extern "C" {
#pragma GCC visibility push(default)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-declarations"

b3::Status b3SubmitClientCommandAndWaitStatus(b3::Client client, b3::Command command) {
  ++reinterpret_cast<StubEngine*>(client)->commands;
  answer = Answer{};
  answer.engine = toOrder(command).engine;
  if (carryOut(toOrder(command))) answer.kind = toOrder(command).kind;
  return reinterpret_cast<b3::Status>(&answer);
}

b3::Command b3RequestActualStateCommandInit(b3::Client client, int body) {
  return begin(client, Kind::kState, body);
}
int b3GetStatusActualState(b3::Status status, int*, int*, int*, const double**, const double** q,
                           const double** u, const double**) {
  if (toAnswer(status).kind != Kind::kState) return 0;
  if (q) *q = toAnswer(status).q;
  if (u) *u = toAnswer(status).u;
  return 1;
}
int b3GetStatusActualState2(b3::Status status, int*, int* links, int*, int*, const double**,
                            const double**, const double**, const double**, const double**,
                            const double**, const double**, const double**) {
  *links = toAnswer(status).body->links;
  return 1;
}

b3::Command b3CreatePoseCommandInit(b3::Client client, int body) {
  return begin(client, Kind::kPose, body);
}
int b3CreatePoseCommandSetBasePosition(b3::Command command, double x, double y, double z) {
  toOrder(command).has_position = true;
  toOrder(command).state.p_W = Vec3(x, y, z);
  return 0;
}
int b3CreatePoseCommandSetBaseOrientation(b3::Command command, double x, double y, double z,
                                          double w) {
  toOrder(command).has_orientation = true;
  toOrder(command).state.q_WB = Quat(w, x, y, z);
  return 0;
}
int b3CreatePoseCommandSetBaseLinearVelocity(b3::Command command, const double velocity[3]) {
  toOrder(command).has_velocity = true;
  toOrder(command).state.v_W = Vec3(velocity);
  return 0;
}
int b3CreatePoseCommandSetBaseAngularVelocity(b3::Command command, const double velocity[3]) {
  toOrder(command).has_spin = true;
  toOrder(command).state.w_W = Vec3(velocity);
  return 0;
}

b3::Command b3GetDynamicsInfoCommandInit(b3::Client client, int body, int) {
  return begin(client, Kind::kDynamics, body);
}
int b3GetDynamicsInfo(b3::Status status, b3::DynamicsInfo* info) {
  if (toAnswer(status).kind != Kind::kDynamics) return 0;
  const StubBody& body = *toAnswer(status).body;
  info->mass = body.mass;
  std::copy_n(body.inertia.data(), 3, info->inertia);
  info->friction = body.friction;
  // Stale values of another answer.
  info->restitution = body.is_multibody ? body.restitution : 0.77;
  info->rolling_friction = body.is_multibody ? body.rolling_friction : 0.77;
  info->spinning_friction = body.is_multibody ? body.spinning_friction : 0.77;
  info->contact_stiffness = body.is_multibody ? body.contact_stiffness : 0.77;
  info->contact_threshold = body.is_multibody ? body.contact_threshold : 0.77;
  info->activation_state = body.may_sleep ? 1 : b3::kNeverSleeps;
  info->body_type = body.is_soft        ? b3::kSoftBody
                    : body.is_multibody ? b3::kMultiBody
                                        : b3::kRigidBody;
  info->linear_damping = body.linear_damping;
  info->angular_damping = body.angular_damping;
  return 1;
}
b3::Command b3InitChangeDynamicsInfo(b3::Client client) { return begin(client, Kind::kChange, -1); }
int b3ChangeDynamicsInfoSetMass(b3::Command command, int body, int, double mass) {
  toOrder(command).body = body;
  toOrder(command).has_mass = true;
  toOrder(command).mass = mass;
  return 0;
}
int b3ChangeDynamicsInfoSetLocalInertiaDiagonal(b3::Command command, int body, int,
                                                const double inertia[3]) {
  toOrder(command).body = body;
  toOrder(command).has_inertia = true;
  toOrder(command).inertia = Vec3(inertia);
  return 0;
}
int b3ChangeDynamicsInfoSetLinearDamping(b3::Command command, int body, double damping) {
  toOrder(command).body = body;
  toOrder(command).has_linear = true;
  toOrder(command).linear = damping;
  return 0;
}
int b3ChangeDynamicsInfoSetAngularDamping(b3::Command command, int body, double damping) {
  toOrder(command).body = body;
  toOrder(command).has_angular = true;
  toOrder(command).angular = damping;
  return 0;
}
int b3ChangeDynamicsInfoSetLateralFriction(b3::Command command, int body, int, double friction) {
  toOrder(command).body = body;
  toOrder(command).has_friction = true;
  toOrder(command).friction = friction;
  return 0;
}
int b3ChangeDynamicsInfoSetRestitution(b3::Command command, int body, int, double restitution) {
  toOrder(command).body = body;
  toOrder(command).has_restitution = true;
  toOrder(command).restitution = restitution;
  return 0;
}
int b3ChangeDynamicsInfoSetContactProcessingThreshold(b3::Command command, int body, int,
                                                      double distance) {
  toOrder(command).body = body;
  toOrder(command).has_threshold = true;
  toOrder(command).threshold = distance;
  return 0;
}
int b3ChangeDynamicsInfoSetActivationState(b3::Command command, int body, int bits) {
  toOrder(command).body = body;
  toOrder(command).activation = bits;
  return 0;
}

b3::Command b3InitRequestPhysicsParamCommand(b3::Client client) {
  return begin(client, Kind::kParameters, -1);
}
int b3GetStatusPhysicsSimulationParameters(b3::Status status, b3::SimulationParameters* all) {
  if (toAnswer(status).kind != Kind::kParameters) return 0;
  const StubEngine& engine = *toAnswer(status).engine;
  all->time_step = engine.time_step;
  all->substeps = engine.substeps;
  std::copy_n(engine.gravity.data(), 3, all->gravity);
  return 1;
}

b3::Command b3InitRequestCollisionShapeInformation(b3::Client client, int body, int) {
  return begin(client, Kind::kShape, body);
}
void b3GetCollisionShapeInformation(b3::Client, b3::CollisionShapeInformation* shape) {
  shape->count = static_cast<int>(cached_shape.size());
  shape->pieces = cached_shape.data();
}

b3::Command b3CollisionFilterCommandInit(b3::Client client) {
  return begin(client, Kind::kFilter, -1);
}
void b3SetCollisionFilterPair(b3::Command command, int body_a, int body_b, int, int, int collides) {
  toOrder(command).body = body_a;
  toOrder(command).other = body_b;
  toOrder(command).collides = collides != 0;
}

#pragma GCC diagnostic pop
#pragma GCC visibility pop
}  // extern "C"
