#include "engine.h"

#include <algorithm>

namespace tandem::pybullet {
namespace {

constexpr int kBase = -1;  // link number of the base

}  // namespace

bool Engine::readState(int body, TandemState& state) const {
  const b3::Status status = b3_.submit(client_, b3_.make_state_request(client_, body));
  const double* q = nullptr;
  const double* u = nullptr;
  if (!status || !b3_.get_state(status, nullptr, nullptr, nullptr, nullptr, &q, &u, nullptr)) {
    return false;
  }
  std::copy_n(q, 3, state.position);
  std::copy_n(q + 3, 4, state.orientation);
  std::copy_n(u, 3, state.velocity);
  std::copy_n(u + 3, 3, state.angular_velocity);
  return true;
}

void Engine::writeVelocities(int body, const TandemState& state) const {
  const b3::Command command = b3_.make_pose(client_, body);
  b3_.set_velocity(command, state.velocity);
  b3_.set_angular_velocity(command, state.angular_velocity);
  b3_.submit(client_, command);
}

void Engine::writeState(int body, const TandemState& state) const {
  const double* const p = state.position;
  const double* const q = state.orientation;
  const b3::Command command = b3_.make_pose(client_, body);
  b3_.set_position(command, p[0], p[1], p[2]);
  b3_.set_orientation(command, q[0], q[1], q[2], q[3]);
  b3_.set_velocity(command, state.velocity);
  b3_.set_angular_velocity(command, state.angular_velocity);
  b3_.submit(client_, command);
}

std::optional<BodyFacts> Engine::readFacts(int body) const {
  // The state comes first: only it tells reliably whether the body exists, and its number of links.
  b3::Status status = b3_.submit(client_, b3_.make_state_request(client_, body));
  if (!status ||
      !b3_.get_state(status, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr)) {
    return std::nullopt;
  }
  BodyFacts facts;
  b3_.get_state_and_links(status, nullptr, &facts.links, nullptr, nullptr, nullptr, nullptr,
                          nullptr, nullptr, nullptr, nullptr, nullptr, nullptr);
  b3::DynamicsInfo info{};
  status = b3_.submit(client_, b3_.make_dynamics_request(client_, body, kBase));
  if (!status || !b3_.get_dynamics(status, &info)) return std::nullopt;
  facts.mass = info.mass;
  std::copy_n(info.inertia, 3, facts.inertia);
  facts.friction = info.friction;
  facts.linear_damping = info.linear_damping;
  facts.angular_damping = info.angular_damping;
  facts.is_multibody = info.body_type == b3::kMultiBody;
  facts.is_soft = info.body_type == b3::kSoftBody;
  // For a btRigidBody the answer holds old values.
  if (facts.is_multibody) {
    facts.restitution = info.restitution;
    facts.rolling_friction = info.rolling_friction;
    facts.spinning_friction = info.spinning_friction;
    facts.has_soft_contact = info.contact_stiffness > 0.0;
    facts.contact_threshold = info.contact_threshold;
  }
  facts.may_sleep = info.activation_state != b3::kNeverSleeps;
  return facts;
}

void Engine::writeMass(int body, double mass, const double inertia[3]) const {
  // A new mass alone resets the inertia to that of the shape.
  const b3::Command command = b3_.make_dynamics_change(client_);
  b3_.change_mass(command, body, kBase, mass);
  b3_.change_inertia(command, body, kBase, inertia);
  b3_.submit(client_, command);
}

void Engine::writeDamping(int body, double linear, double angular) const {
  const b3::Command command = b3_.make_dynamics_change(client_);
  b3_.change_linear_damping(command, body, linear);
  b3_.change_angular_damping(command, body, angular);
  b3_.submit(client_, command);
}

void Engine::writeFriction(int body, double friction) const {
  const b3::Command command = b3_.make_dynamics_change(client_);
  b3_.change_friction(command, body, kBase, friction);
  b3_.submit(client_, command);
}

void Engine::writeRestitution(int body, double restitution) const {
  const b3::Command command = b3_.make_dynamics_change(client_);
  b3_.change_restitution(command, body, kBase, restitution);
  b3_.submit(client_, command);
}

void Engine::writeContactThreshold(int body, double distance) const {
  const b3::Command command = b3_.make_dynamics_change(client_);
  b3_.change_contact_threshold(command, body, kBase, distance);
  b3_.submit(client_, command);
}

void Engine::letSleep(int body, bool may_sleep) const {
  const b3::Command command = b3_.make_dynamics_change(client_);
  b3_.change_activation(command, body, may_sleep ? b3::kEnableSleeping : b3::kDisableSleeping);
  b3_.submit(client_, command);
}

void Engine::setCollides(int body_a, int body_b, bool collides) const {
  const b3::Command command = b3_.make_filter(client_);
  b3_.set_pair(command, body_a, body_b, kBase, kBase, collides ? 1 : 0);
  b3_.submit(client_, command);
}

std::optional<EngineParameters> Engine::readParameters() const {
  b3::SimulationParameters asked{};
  const b3::Status status = b3_.submit(client_, b3_.make_parameter_request(client_));
  if (!status || !b3_.get_parameters(status, &asked)) return std::nullopt;
  EngineParameters parameters;
  parameters.step = asked.substeps > 0 ? asked.time_step / asked.substeps : asked.time_step;
  std::copy_n(asked.gravity, 3, parameters.gravity);
  return parameters;
}

std::vector<b3::CollisionShapeData> Engine::readShape(int body) const {
  b3::CollisionShapeInformation shape{};
  if (!b3_.submit(client_, b3_.make_shape_request(client_, body, kBase))) return {};
  b3_.get_shape(client_, &shape);
  // After a failed request the answer is that of an earlier one.
  if (shape.count < 1 || shape.pieces[0].body != body) return {};
  return {shape.pieces, shape.pieces + shape.count};
}

}  // namespace tandem::pybullet
