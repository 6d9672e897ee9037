#include "bench/reference/paper_reference.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <stdexcept>

#include <Eigen/Core>

//        site 1                                site 2
//
//   F_h1 -> [device 1]|[cube 1]|[RDP 21]   [RDP 12]|[cube 2]|[device 2] <- F_h2      --> +x
//              vc1      |    vc21   |          |   vc12   |     vc2
//                       t1         t21        t12         t2
//                       |           |          |          |
//                     cube 2      user 2     user 1     cube 1        all as last received

namespace tandem::reference {
namespace {

// Halvings of a step in which a contact changes: from 2 us to 1e-13 s. Contacts that chatter are
// not followed for ever: this limits all halvings between two instants.
constexpr int kMostHalvings = 24;
constexpr int kMostHalvingsInAll = 4000;

enum Body { kDevice1, kDevice2, kProxy12, kProxy21, kCube1, kCube2, kBodyCount };

using BodyVector = Eigen::Matrix<double, kBodyCount, 1>;

struct Point {
  double x = 0.0;
  double v = 0.0;
};

struct State {
  BodyVector x = BodyVector::Zero();
  BodyVector v = BodyVector::Zero();

  [[nodiscard]] Point at(Body body) const { return {x[body], v[body]}; }
};

// State that one site sends to the other.
struct Packet {
  Point device;
  Point cube;
};

struct Forces {
  double vc1 = 0.0, vc2 = 0.0, vc12 = 0.0, vc21 = 0.0;
  double t1 = 0.0, t2 = 0.0, t12 = 0.0, t21 = 0.0;
};

// Force of `behind` on `ahead` along +x. A contact neither pulls nor acts at a distance.
double contactForce(const SpringDamper& gains, const Point& behind, const Point& ahead) {
  const double overlap = behind.x - ahead.x;
  if (overlap <= 0.0) return 0.0;
  return std::max(0.0, gains.stiffness * overlap + gains.damping * (behind.v - ahead.v));
}

// Force that pulls b towards a.
double couplerForce(const SpringDamper& gains, const Point& a, const Point& b) {
  return gains.stiffness * (a.x - b.x) + gains.damping * (a.v - b.v);
}

class TwoUsers {
 public:
  explicit TwoUsers(const PaperParameters& parameters) : parameters_(parameters) {}

  void send();
  void receive();
  PaperRow sample(double t);
  void advance(double duration);

  [[nodiscard]] const State& state() const { return state_; }

 private:
  [[nodiscard]] bool hasCube() const {
    return parameters_.experiment == Experiment::kCooperativeManipulation;
  }
  [[nodiscard]] bool hasProxies() const { return parameters_.scheme != Scheme::kVirtualCoupling; }
  [[nodiscard]] bool hasDynamicProxies() const {
    return parameters_.scheme == Scheme::kRemoteDynamicProxy;
  }

  [[nodiscard]] Point hip(Body device, const State& state, double tau) const;
  [[nodiscard]] Point proxyOfUser1(const State& state) const;
  [[nodiscard]] Point proxyOfUser2(const State& state) const;
  [[nodiscard]] Forces computeForces(const State& state, double tau) const;
  [[nodiscard]] BodyVector computeAccelerations(const State& state, double tau) const;
  [[nodiscard]] unsigned findPushing(double tau) const;
  void advanceTo(double tau, double step, int depth_left);
  void advanceStep(double tau, double step);

  PaperParameters parameters_;
  State state_;
  State sampled_;     // state at the last tick
  double tau_ = 0.0;  // time since the last tick [s]
  int halvings_left_ = 0;
  double held_vc1_ = 0.0;  // contact forces rendered by the devices in this haptic period [N]
  double held_vc2_ = 0.0;
  std::deque<Packet> from_site_1_;  // packets under way
  std::deque<Packet> from_site_2_;
  Packet at_site_2_;  // the last packets that arrived; initially the start
  Packet at_site_1_;
};

void TwoUsers::send() {
  from_site_1_.push_back({state_.at(kDevice1), state_.at(kCube1)});
  from_site_2_.push_back({state_.at(kDevice2), state_.at(kCube2)});
}

void TwoUsers::receive() {
  at_site_2_ = from_site_1_.front();
  at_site_1_ = from_site_2_.front();
  from_site_1_.pop_front();
  from_site_2_.pop_front();
}

PaperRow TwoUsers::sample(double t) {
  sampled_ = state_;
  tau_ = 0.0;
  const Forces forces = computeForces(state_, tau_);
  held_vc1_ = forces.vc1;
  held_vc2_ = forces.vc2;

  PaperRow row;
  row.t = t;
  row.x1 = state_.x[kDevice1];
  row.x2 = state_.x[kDevice2];
  row.v1 = state_.v[kDevice1];
  row.v2 = state_.v[kDevice2];
  row.xo1 = state_.x[kCube1];
  row.xo2 = state_.x[kCube2];
  row.x12 = proxyOfUser1(state_).x;
  row.x21 = proxyOfUser2(state_).x;
  row.received_xo2 = at_site_1_.cube.x;
  row.received_xo1 = at_site_2_.cube.x;
  row.force_1 = -held_vc1_;
  row.force_2 = held_vc2_;
  return row;
}

Point TwoUsers::hip(Body device, const State& state, double tau) const {
  if (parameters_.hip_motion == HipMotion::kContinuous) return state.at(device);
  const Point last = sampled_.at(device);
  return {last.x + last.v * tau, last.v};
}

Point TwoUsers::proxyOfUser1(const State& state) const {
  if (!hasProxies()) return {};
  return hasDynamicProxies() ? state.at(kProxy12) : at_site_2_.device;
}

Point TwoUsers::proxyOfUser2(const State& state) const {
  if (!hasProxies()) return {};
  return hasDynamicProxies() ? state.at(kProxy21) : at_site_1_.device;
}

Forces TwoUsers::computeForces(const State& state, double tau) const {
  const SpringDamper& vc = parameters_.contact;
  const SpringDamper& t = parameters_.coordination;
  const Point hip_1 = hip(kDevice1, state, tau);
  const Point hip_2 = hip(kDevice2, state, tau);
  const Point proxy_12 = proxyOfUser1(state);
  const Point proxy_21 = proxyOfUser2(state);

  Forces forces;
  if (hasCube()) {
    const Point cube_1 = state.at(kCube1);
    const Point cube_2 = state.at(kCube2);
    forces.vc1 = contactForce(vc, hip_1, cube_1);          // (7)
    forces.vc2 = contactForce(vc, cube_2, hip_2);          // (8)
    forces.t1 = couplerForce(t, cube_1, at_site_1_.cube);  // (9)
    forces.t2 = couplerForce(t, at_site_2_.cube, cube_2);  // (10)
    if (hasProxies()) {
      forces.vc12 = contactForce(vc, proxy_12, cube_2);  // (11)
      forces.vc21 = contactForce(vc, cube_1, proxy_21);  // (12)
    }
  } else if (hasProxies()) {
    forces.vc1 = forces.vc21 = contactForce(vc, hip_1, proxy_21);
    forces.vc2 = forces.vc12 = contactForce(vc, proxy_12, hip_2);
  }
  if (hasDynamicProxies()) {
    forces.t21 = couplerForce(t, proxy_21, at_site_1_.device);  // (13)
    forces.t12 = couplerForce(t, at_site_2_.device, proxy_12);  // (14)
  }
  return forces;
}

BodyVector TwoUsers::computeAccelerations(const State& state, double tau) const {
  const PaperParameters& p = parameters_;
  const BodyVector& v = state.v;
  const Forces f = computeForces(state, tau);
  const double copy_mass = p.object_mass / 2.0;

  BodyVector a = BodyVector::Zero();
  a[kDevice1] =
      (p.hand_force_1 - held_vc1_ - p.device_damping * v[kDevice1]) / p.proxy_mass;  // (1)
  a[kDevice2] =
      (p.hand_force_2 + held_vc2_ - p.device_damping * v[kDevice2]) / p.proxy_mass;  // (2)
  if (hasDynamicProxies()) {
    a[kProxy12] = (f.t12 - f.vc12 - p.proxy_damping * v[kProxy12]) / p.proxy_mass;  // (3)
    a[kProxy21] = (f.vc21 - f.t21 - p.proxy_damping * v[kProxy21]) / p.proxy_mass;  // (4)
  }
  if (hasCube()) {
    a[kCube1] = (f.vc1 - f.t1 - f.vc21 - p.object_damping * v[kCube1]) / copy_mass;  // (5)
    a[kCube2] = (f.vc12 + f.t2 - f.vc2 - p.object_damping * v[kCube2]) / copy_mass;  // (6)
  }
  return a;
}

void TwoUsers::advance(double duration) {
  const int steps = countSteps(duration, parameters_.step);
  const double step = duration / steps;
  halvings_left_ = kMostHalvingsInAll;
  for (int i = 0; i < steps; ++i) advanceTo(tau_ + i * step, step, kMostHalvings);
  tau_ += duration;
}

// One bit for each contact that pushes.
unsigned TwoUsers::findPushing(double tau) const {
  const Forces forces = computeForces(state_, tau);
  return (forces.vc1 > 0.0) + 2u * (forces.vc2 > 0.0) + 4u * (forces.vc12 > 0.0) +
         8u * (forces.vc21 > 0.0);
}

// Halves a step in which a contact begins or ends, until it is located.
void TwoUsers::advanceTo(double tau, double step, int depth_left) {
  const State before = state_;
  const unsigned pushing = findPushing(tau);
  advanceStep(tau, step);
  if (depth_left == 0 || halvings_left_ == 0 || findPushing(tau + step) == pushing) return;
  --halvings_left_;
  state_ = before;
  const double half = step / 2.0;
  advanceTo(tau, half, depth_left - 1);
  advanceTo(tau + half, half, depth_left - 1);
}

// Runge-Kutta 4 for x'' = a(x, x', tau).
void TwoUsers::advanceStep(double tau, double step) {
  const double half = step / 2.0;
  const State s1 = state_;
  const BodyVector a1 = computeAccelerations(s1, tau);
  const State s2{s1.x + half * s1.v, s1.v + half * a1};
  const BodyVector a2 = computeAccelerations(s2, tau + half);
  const State s3{s1.x + half * s2.v, s1.v + half * a2};
  const BodyVector a3 = computeAccelerations(s3, tau + half);
  const State s4{s1.x + step * s3.v, s1.v + step * a3};
  const BodyVector a4 = computeAccelerations(s4, tau + step);
  state_.x += step / 6.0 * (s1.v + 2.0 * s2.v + 2.0 * s3.v + s4.v);
  state_.v += step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
}

PaperSummary summarize(const std::vector<PaperRow>& rows, const State& end) {
  PaperSummary summary;
  std::array<bool, 2> touching{};
  for (const PaperRow& row : rows) {
    const double error = std::abs(row.xo1 - row.xo2);
    summary.coherency_mean += error;
    summary.coherency_max = std::max(summary.coherency_max, error);
    summary.received_mean[0] += std::abs(row.xo1 - row.received_xo2);
    summary.received_mean[1] += std::abs(row.xo2 - row.received_xo1);

    const std::array<double, 2> force{std::abs(row.force_1), std::abs(row.force_2)};
    for (std::size_t site = 0; site < 2; ++site) {
      summary.force_mean[site] += force[site];
      summary.force_max[site] = std::max(summary.force_max[site], force[site]);
      if ((force[site] > 0.0) != touching[site]) {
        touching[site] = !touching[site];
        ++summary.contact_transitions[site];
      }
    }
  }
  const double count = static_cast<double>(rows.size());
  summary.coherency_mean /= count;
  for (std::size_t site = 0; site < 2; ++site) {
    summary.received_mean[site] /= count;
    summary.force_mean[site] /= count;
  }
  summary.device_end = {end.x[kDevice1], end.x[kDevice2]};
  return summary;
}

}  // namespace

PaperParameters makeCooperativeManipulation(Scheme scheme) {
  PaperParameters parameters;
  parameters.scheme = scheme;
  return parameters;
}

PaperParameters makeUserContact(Scheme scheme) {
  PaperParameters parameters;
  parameters.experiment = Experiment::kUserContact;
  parameters.scheme = scheme;
  parameters.hand_force_1 = 3.0;
  parameters.contact = {2000.0, 1.0};
  parameters.coordination = {200.0, 10.0};
  parameters.sampling.delay = 0.1;
  parameters.sampling.duration = 2.0;
  return parameters;
}

PaperResult runPaperModel(const PaperParameters& parameters) {
  if (!(parameters.object_mass > 0.0) || !(parameters.proxy_mass > 0.0) ||
      !(parameters.step > 0.0)) {
    throw std::invalid_argument("runPaperModel: masses and step must be positive");
  }
  SampleClock clock(parameters.sampling);
  TwoUsers users(parameters);
  PaperResult result;
  double t = 0.0;
  for (Instant now = clock.next();; now = clock.next()) {
    users.advance(now.t - t);
    t = now.t;
    if (now.ends) break;
    if (now.sends) users.send();
    if (now.receives) users.receive();
    if (now.ticks) result.rows.push_back(users.sample(t));
  }
  result.summary = summarize(result.rows, users.state());
  return result;
}

}  // namespace tandem::reference
