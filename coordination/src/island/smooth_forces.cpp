#include "island/smooth_forces.h"

#include <algorithm>

#include "geometry/held_face.h"
#include "geometry/turn.h"

namespace tandem {
namespace {

// Numbers of values of a mover in the state vector.
constexpr int kWay = 6, kWayAndTurn = SmoothForces::kMaxSize;

}  // namespace

SmoothForces::SmoothForces(const IslandModel& model, std::size_t max_touches, JointForces& joints)
    : period_(model.settings.haptic_period), joints_(joints) {
  const std::size_t n = model.bodies.size();
  movers_.reserve(n);
  springs_.reserve(model.couplers.size());
  driven_.reserve(n);
  contacts_.reserve(max_touches);
  pulls_.reserve(model.grips.size());
  frames_.reserve(n + max_touches);
  frame_of_.resize(n);
}

void SmoothForces::choose(const IslandModel& model, const std::vector<char>& together,
                          const std::vector<char>& alone,
                          const std::vector<Touch>& touches) noexcept {
  movers_.clear(), springs_.clear(), driven_.clear(), contacts_.clear(), frames_.clear();
  pulls_.clear();
  size_ = 0;
  std::fill(frame_of_.begin(), frame_of_.end(), -1);
  for (const BodyIndex b : model.present) {
    if (together[b]) addMover(model, b, alone[b]);
  }
  tieCouplers(model);
  for (const BodyIndex b : joints_.ends()) {
    const auto frame = static_cast<std::size_t>(findFrame(model, b));
    if (frame < movers_.size()) movers_[frame].needs_rotation = movers_[frame].turns;
  }
  for (const Touch& touch : touches) addContact(model, touch);
  for (const int g : model.present_grips) addPull(model, model.grips[g]);
}

void SmoothForces::addMover(const IslandModel& model, BodyIndex b, bool is_alone) noexcept {
  const ModelBody& body = model.bodies[b];
  Mover mover;
  mover.body = b;
  mover.offset = size_;
  mover.turns = body.rotates();
  mover.radius = body.bounding_radius;
  mover.is_round = body.isRound();
  const MassFactors& factors = body.factors;
  if (!factors.areEven()) mover.factors = &factors;
  mover.needs_rotation = mover.turns && !mover.is_round;
  mover.inertia_B = PlainVec(body.settings.inertia_B);
  if (factors.angular != 1.0) mover.inertia_B = mover.inertia_B / factors.angular;
  mover.inverse_inertia_B = PlainVec(body.inverse_inertia_B);
  mover.t_rest_W = PlainVec(body.t_external_W);
  mover.turn_rate = limitDamping(body.settings.angular_damping, 1.0);
  if (!is_alone) {
    mover.inverse_mass = body.inverse_mass;
    if (mover.factors == nullptr)
      mover.damping = limitDamping(body.damping() / factors.linear, body.inverse_mass);
    else
      mover.decay = limitDamping(body.decay(), 1.0);
    mover.f_rest_W = PlainVec(body.f_external_W);
  }
  frame_of_[b] = static_cast<int>(frames_.size());
  frames_.emplace_back();
  frames_.back().R_WB = PlainRotation(body.state.q_WB);
  movers_.push_back(mover);
  size_ += mover.turns ? kWayAndTurn : kWay;
}

/// Limits a damper to the shortest step (0.3 us at 1 kHz), since a faster stop would diverge.
/// Nobody can feel the difference.
double SmoothForces::limitDamping(double damping, double mobility) const noexcept {
  const double most = kDecayPerStep * kMostStepsPerPeriod / period_;
  return damping * mobility > most ? most / mobility : damping;
}

void SmoothForces::tieCouplers(const IslandModel& model) noexcept {
  for (const int c : model.present_couplers) {
    const ModelCoupler& coupler = model.couplers[c];
    const int index = frame_of_[coupler.follower];
    if (index < 0) continue;
    Mover& mover = movers_[index];
    const CouplerGains &linear = coupler.now.linear, &angular = coupler.now.angular;
    if (mover.inverse_mass > 0.0) {
      // Several springs act as one, at rest between their targets.
      const PlainVec p_target(coupler.target.p_W);
      mover.stiffness += linear.stiffness;
      if (linear.stiffness > 0.0)
        mover.p_rest =
            mover.p_rest + (linear.stiffness / mover.stiffness) * (p_target - mover.p_rest);
      const double damping = limitDamping(linear.damping, mover.inverse_mass);
      mover.damping += damping;
      mover.f_rest_W = mover.f_rest_W + damping * PlainVec(coupler.target.v_W);
    }
    if (!mover.turns) continue;
    const double damping =
        limitDamping(angular.damping, model.bodies[mover.body].inverse_inertia_B.maxCoeff());
    mover.turn_damping += damping;
    mover.t_rest_W = mover.t_rest_W + damping * PlainVec(coupler.target.w_W);
    if (angular.stiffness == 0.0) continue;
    const Quat& q = coupler.target.q_WB;
    springs_.push_back({index, angular.stiffness, {q.x(), q.y(), q.z(), q.w()}, 1.0, 1.0});
  }
}

int SmoothForces::findFrame(const IslandModel& model, BodyIndex b) noexcept {
  if (frame_of_[b] >= 0) return frame_of_[b];
  const ModelBody& body = model.bodies[b];
  frame_of_[b] = static_cast<int>(frames_.size());
  frames_.emplace_back();
  frames_.back().R_WB = PlainRotation(body.state.q_WB);
  driven_.push_back({});
  driven_.back().body = b;
  driven_.back().frame = frame_of_[b];
  driven_.back().goes_on = body.settings.motion == Motion::kPrescribed;
  return frame_of_[b];
}

void SmoothForces::addContact(const IslandModel& model, const Touch& touch) noexcept {
  Contact contact;
  contact.sphere = findFrame(model, touch.sphere);
  contact.radius =
      std::get<Sphere>(model.bodies[touch.sphere].settings.shape).radius - touch.allowance;
  contact.gains = touch.gains;
  contact.touched = touch.touched;
  double mobility = model.bodies[touch.sphere].mobility;
  if (!touch.obstacle) mobility += model.bodies[touch.other].mobility;
  contact.gains.damping = limitDamping(touch.gains.damping, mobility);
  contact.guard_scale = contact.gains.stiffness + contact.gains.damping / period_;
  contact.shape = &shapeOf(model, touch);
  contact.part = touch.part;
  contact.piece = touch.piece;
  if (touch.obstacle) {
    contact.other = static_cast<int>(frames_.size());
    frames_.emplace_back();
    frames_.back().p = PlainVec(touch.obstacle->p_WB);
    frames_.back().R_WB = PlainRotation(touch.obstacle->q_WB);
  } else {
    contact.other = findFrame(model, touch.other);
    const auto other = static_cast<std::size_t>(contact.other);
    if (other < movers_.size() && !std::holds_alternative<Sphere>(wholeShapeOf(model, touch)))
      movers_[other].needs_rotation = movers_[other].turns;
  }
  contacts_.push_back(contact);
}

/// Bodies that forces do not move need no pull.
void SmoothForces::addPull(const IslandModel& model, const ModelGrip& grip) noexcept {
  const BodyIndex b = grip.hold.body;
  if (frame_of_[grip.hand] < 0 && frame_of_[b] < 0) return;
  Pull& pull = pulls_.emplace_back();
  pull.hand = findFrame(model, grip.hand);
  pull.body = findFrame(model, b);
  pull.law = GripLaw(grip.hold);
  const ModelBody &hand = model.bodies[grip.hand], &body = model.bodies[b];
  const double arm = grip.hold.p_FG.norm();
  const double turning = body.inverse_inertia_B.maxCoeff();
  pull.law.limitDamping(
      limitDamping(pull.law.damping(), hand.inverse_mass + body.inverse_mass + turning * arm * arm),
      limitDamping(pull.law.turnDamping(), turning));
  const Quat& q = grip.hold.q_WF;
  std::copy_n(q.coeffs().data(), 4, pull.target);
  if (pull.body >= static_cast<int>(movers_.size())) return;
  Mover& mover = movers_[static_cast<std::size_t>(pull.body)];
  pull.turns = mover.turns;
  mover.needs_rotation = mover.turns;
}

void SmoothForces::hold(const std::vector<HeldWrench>& held) noexcept {
  for (Mover& mover : movers_) {
    const HeldWrench& its = held[mover.body];
    mover.f_held_W = PlainVec(its.start.f_W);
    mover.t_held_W = PlainVec(its.start.t_W);
    mover.f_held_rate_W = PlainVec(its.rate.f_W);
    mover.t_held_rate_W = PlainVec(its.rate.t_W);
  }
}

void SmoothForces::load(const States& states, double* y) noexcept {
  for (const Mover& mover : movers_) {
    const RigidState& s = states[mover.body];
    double* values = y + mover.offset;
    PlainVec(s.p_W).store(values);
    PlainVec(s.v_W).store(values + 3);
    if (!mover.turns) continue;
    std::copy_n(s.q_WB.coeffs().data(), 4, values + kQ);
    PlainVec(s.w_W).store(values + kW);
    values[kWayAndTurn - 1] = 0.0;
  }
  for (Driven& driven : driven_) {
    const RigidState& s = states[driven.body];
    Frame& frame = frames_[driven.frame];
    frame.v = PlainVec(s.v_W);
    frame.w = PlainVec(s.w_W);
    driven.p = PlainVec(s.p_W);
    driven.rate = driven.goes_on ? frame.v : PlainVec();
    driven.turns = driven.goes_on && s.w_W != Vec3::Zero();
    driven.q_WB = s.q_WB;
  }
}

void SmoothForces::store(const double* y, States& states) const noexcept {
  for (const Mover& mover : movers_) {
    RigidState& s = states[mover.body];
    const double* values = y + mover.offset;
    s.p_W = PlainVec(values).toVec3();
    s.v_W = PlainVec(values + 3).toVec3();
    if (!mover.turns) continue;
    s.q_WB = Quat(values + kQ).normalized();
    s.w_W = PlainVec(values + kW).toVec3();
  }
}

void SmoothForces::evaluate(double t, const double* y, double* k, Look look) noexcept {
  placeFrames(t, y);
  for (TurnSpring& spring : springs_) {
    Frame& frame = frames_[spring.mover];
    const double* q = y + movers_[spring.mover].offset + kQ;
    if (look != Look::kPushing) {
      spring.side_now = computeTurnSide(q, spring.target) < 0.0 ? -1.0 : 1.0;
      if (look == Look::kDecide) spring.side = spring.side_now;
    }
    frame.t_W = frame.t_W + spring.stiffness * computeTurn(q, spring.target, spring.side);
  }
  for (Contact& contact : contacts_)
    if (contact.pushes || look != Look::kPushing) push(contact, look);
  for (Pull& one : pulls_) pull(one, y, look);
  computeRates(y, k);
  if (!joints_.isEmpty()) join(t, y, k);
}

void SmoothForces::acceptFaces() noexcept {
  for (Contact& contact : contacts_) contact.face = contact.entered;
}

bool SmoothForces::hasTurnedOver() const noexcept {
  const auto hasTurned = [](const auto& spring) { return spring.side != spring.side_now; };
  return std::any_of(springs_.begin(), springs_.end(), hasTurned) ||
         std::any_of(pulls_.begin(), pulls_.end(), hasTurned);
}

void SmoothForces::placeFrames(double t, const double* y) noexcept {
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const Mover& mover = movers_[i];
    Frame& frame = frames_[i];
    const double* values = y + mover.offset;
    frame.p = PlainVec(values);
    frame.v = PlainVec(values + 3);
    frame.f_W = mover.f_rest_W + mover.f_held_W + t * mover.f_held_rate_W +
                mover.stiffness * (mover.p_rest - frame.p) - mover.damping * frame.v;
    if (!mover.turns) continue;
    frame.w = PlainVec(values + kW);
    frame.t_W =
        mover.t_rest_W + mover.t_held_W + t * mover.t_held_rate_W - mover.turn_damping * frame.w;
    if (mover.needs_rotation) frame.R_WB = PlainRotation(values + kQ);
  }
  for (const Driven& driven : driven_) {
    Frame& frame = frames_[driven.frame];
    frame.p = driven.p + t * driven.rate;
    if (!driven.turns) continue;
    RigidState state;
    state.q_WB = driven.q_WB;
    state.w_W = frame.w.toVec3();
    goOn(state, t);
    frame.R_WB = PlainRotation(state.q_WB);
  }
}

/// Separation of a centre by the face that it has entered, else by the nearest that may push it.
Separation SmoothForces::separate(const Contact& contact, const PlainVec& c_B, Look look) noexcept {
  const Shape& shape = *contact.shape;
  if (contact.face >= 0 && look != Look::kDecide)
    return leaveAnyByFace(c_B, shape, contact.piece, contact.face);
  if (contact.piece >= 0)
    return tandem::separate(c_B, *std::get_if<Mesh>(&shape), contact.piece, contact.touched);
  // Between measured states no centre goes through a shape.
  if (look == Look::kPushing) return tandem::separate(c_B, shape);
  return tandem::separate(c_B, shape, contact.touched);
}

void SmoothForces::push(Contact& contact, Look look) noexcept {
  Frame &sphere = frames_[contact.sphere], &other = frames_[contact.other];
  PlainVec c = other.R_WB.toBody(sphere.p - other.p);
  if (contact.part) c = contact.part->toPart(c);
  if (look == Look::kDecide) contact.face = -1;
  const Separation found = separate(contact, c, look);
  const PlainVec n = other.R_WB.toWorld(contact.part ? contact.part->toBody(found.n) : found.n);
  // From the other body's centre to the nearest point of its surface.
  const PlainVec arm = sphere.p - other.p - found.distance * n;
  const double overlap = contact.radius - found.distance;
  const double rate = -dot(n, sphere.v - other.v - cross(other.w, arm));
  const double force = contact.gains.stiffness * overlap + contact.gains.damping * rate;
  if (look != Look::kPushing) {
    contact.under = found.under;
    contact.overlap = overlap;
    contact.rate = rate;
    contact.guard =
        contact.guard_scale > 0.0 ? std::min(overlap, force / contact.guard_scale) : -1.0;
    if (contact.piece >= 0 && contact.face < 0 && (found.aside > 0.0 || look == Look::kAll)) {
      // The sphere is beside the pushing region: no force at any gap. Entering the region is an
      // event, so that the first touch is detected.
      contact.guard = contact.overlap = -found.aside;
      contact.rate = 0.0;
    }
    if (look == Look::kDecide) {
      contact.pushes = contact.guard > 0.0;
      contact.face = found.face;
    }
    const bool leaves_by_face =
        contact.piece >= 0 || (contact.pushes && found.face >= 0 && found.distance < 0.0);
    contact.entered = leaves_by_face ? found.face : -1;
    if (contact.face >= 0) {
      const double lead =
          computeAnyFaceLead(c, *contact.shape, contact.piece, contact.face, contact.touched);
      // A change of face is an event; for a piece of a mesh also before it is touched.
      if (contact.pushes)
        contact.guard = std::min(contact.guard, lead);
      else if (contact.piece >= 0)
        contact.guard = std::max(contact.guard, -lead);
    }
    if (!contact.pushes) return;
  }
  // The line of force passes through the sphere's centre: no torque on the sphere.
  const PlainVec f = force * n;
  sphere.f_W = sphere.f_W + f;
  other.f_W = other.f_W - f;
  other.t_W = other.t_W - cross(arm, f);
}

void SmoothForces::pull(Pull& pull, const double* y, Look look) noexcept {
  Frame &hand = frames_[pull.hand], &body = frames_[pull.body];
  PlainVec turn;
  if (pull.turns) {
    const double* q = y + movers_[pull.body].offset + kQ;
    if (look != Look::kPushing) {
      pull.side_now = computeTurnSide(q, pull.target) < 0.0 ? -1.0 : 1.0;
      if (look == Look::kDecide) pull.side = pull.side_now;
    }
    turn = computeTurn(q, pull.target, pull.side);
  }
  const PlainVec arm = body.R_WB.toWorld(pull.law.place());
  const GripLaw::Pull found =
      pull.law.compute(hand.p - body.p - arm, hand.v - body.v - cross(body.w, arm), turn, body.w);
  const PlainVec f = found.f + found.load;
  body.f_W = body.f_W + f;
  body.t_W = body.t_W + cross(arm, f) + found.t;
  hand.f_W = hand.f_W - found.f;
}

void SmoothForces::computeRates(const double* y, double* k) const noexcept {
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const Mover& mover = movers_[i];
    const Frame& frame = frames_[i];
    double* rates = k + mover.offset;
    frame.v.store(rates);
    if (mover.factors == nullptr)
      (mover.inverse_mass * frame.f_W).store(rates + 3);
    else
      accelerateByFactors(mover, frame, rates);
    if (!mover.turns) continue;
    // q' = w q / 2
    const double* q = y + mover.offset + kQ;
    const PlainVec w = frame.w;
    rates[kQ] = 0.5 * (w.x * q[3] + w.y * q[2] - w.z * q[1]);
    rates[kQ + 1] = 0.5 * (w.y * q[3] + w.z * q[0] - w.x * q[2]);
    rates[kQ + 2] = 0.5 * (w.z * q[3] + w.x * q[1] - w.y * q[0]);
    rates[kQ + 3] = -0.5 * (w.x * q[0] + w.y * q[1] + w.z * q[2]);
    // Euler's equation in B: I w' = t - w x I w.
    PlainVec alpha;
    if (mover.factors != nullptr && !mover.factors->turn_is_even) {
      alpha = turnByFactors(mover, frame);
    } else if (mover.is_round) {
      alpha = mover.inverse_inertia_B.x * frame.t_W;
    } else {
      const PlainVec w_B = frame.R_WB.toBody(w), t_B = frame.R_WB.toBody(frame.t_W);
      alpha = frame.R_WB.toWorld(multiplyEach(
          mover.inverse_inertia_B, t_B - cross(w_B, multiplyEach(mover.inertia_B, w_B))));
    }
    (alpha - mover.turn_rate * w).store(rates + kW);
    rates[kWayAndTurn - 1] = 0.0;
  }
}

/// Adds what joints do to the rates.
void SmoothForces::join(double t, const double* y, double* k) noexcept {
  const auto moverOf = [&](BodyIndex b) -> const Mover* {
    const auto frame = static_cast<std::size_t>(frame_of_[b]);
    return frame < movers_.size() ? &movers_[frame] : nullptr;
  };
  for (const BodyIndex b : joints_.ends()) {
    JointForces::End& end = joints_.end(b);
    const Frame& frame = frames_[frame_of_[b]];
    end = {};
    end.state.p_W = frame.p.toVec3();
    end.state.v_W = frame.v.toVec3();
    end.state.w_W = frame.w.toVec3();
    if (const Mover* mover = moverOf(b)) {
      const double* rates = k + mover->offset;
      end.a_W = PlainVec(rates + 3).toVec3();
      if (!mover->turns) continue;
      end.state.q_WB = Quat(y + mover->offset + kQ).normalized();
      end.alpha_W = PlainVec(rates + kW).toVec3();
    }
  }
  for (const Driven& driven : driven_) {
    if (!joints_.isEnd(driven.body)) continue;
    RigidState& state = joints_.end(driven.body).state;
    state.q_WB = driven.q_WB;
    if (driven.turns) {
      const Vec3 p_W = state.p_W;
      goOn(state, t);
      state.p_W = p_W;
    }
    // A held body stays: its velocity counts in dampers only.
    if (!driven.goes_on) state.v_W = state.w_W = Vec3::Zero();
  }
  joints_.solve();
  for (const BodyIndex b : joints_.ends()) {
    const Mover* mover = moverOf(b);
    if (!mover) continue;
    PlainVec(joints_.end(b).a_W).store(k + mover->offset + 3);
    if (mover->turns) PlainVec(joints_.end(b).alpha_W).store(k + mover->offset + kW);
  }
}

[[gnu::noinline]] void SmoothForces::accelerateByFactors(const Mover& mover, const Frame& frame,
                                                         double* rates) noexcept {
  const PlainVec felt_W = multiplyEach(PlainVec(mover.factors->way_W), frame.f_W);
  (mover.inverse_mass * felt_W - mover.decay * frame.v).store(rates + 3);
}

/// With uneven factors there is no gyroscopic torque: it would turn the body about a fixed axis.
[[gnu::noinline]] PlainVec SmoothForces::turnByFactors(const Mover& mover,
                                                       const Frame& frame) noexcept {
  const PlainVec root_W(mover.factors->turn_root_W);
  const PlainVec t_B = frame.R_WB.toBody(multiplyEach(root_W, frame.t_W));
  return multiplyEach(root_W, frame.R_WB.toWorld(multiplyEach(mover.inverse_inertia_B, t_B)));
}

}  // namespace tandem
