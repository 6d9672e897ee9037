#include "island/slot_motion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "island/guide_lines.h"

namespace tandem {
namespace {

/// Extent of a body at its start along a direction of W, for the clearance at set-up [m].
double computeExtent(const IslandBody& body, const Vec3& direction_W) {
  if (std::holds_alternative<Plane>(body.shape))
    throw std::invalid_argument(
        "a plane cannot be a body of a guided island; leave experiment.guide off");
  return computeReach(body.shape, body.start.q_WB.conjugate() * direction_W);
}

/// Smaller gaps at set-up are rounding: bodies placed "just in contact" have a gap of exactly zero
/// [m].
constexpr double kPlacementRounding = 1e-12;

/// Levels below the coarsest down to which a touch made and broken within a step is searched. In
/// 1/128 rad of the fastest oscillation such a touch transfers nothing.
constexpr int kLevelsOfHiddenTouch = 6;

}  // namespace

SlotMotion::SlotMotion(const IslandModel& model)
    : axis_(*model.settings.guide), period_(model.settings.haptic_period) {
  for (const ModelBody& body : model.bodies) {
    // A ghost may become dynamic again.
    const bool moves = body.settings.motion == Motion::kDynamic;
    freedom_.push_back(moves ? static_cast<int>(movers_.size()) : -1);
    if (moves) movers_.push_back(static_cast<BodyIndex>(origins_.size()));
    origins_.push_back(body.settings.start.p_W);
  }

  const auto place = [&](BodyIndex b) { return axis_.dot(origins_[b]); };
  for (const IslandContact& pair : model.contacts) {
    const double sphere = place(pair.sphere), other = place(pair.other);
    // Bodies keep their order along the guide: a pair with a third body between never meets.
    const auto is_between = [&](BodyIndex b) {
      const double p = place(b);
      return b != pair.sphere && b != pair.other &&
             p > std::min(sphere, other) + kPlacementRounding &&
             p < std::max(sphere, other) - kPlacementRounding && canMeet(model, b, pair.sphere) &&
             canMeet(model, b, pair.other);
    };
    bool blocked = false;
    for (BodyIndex b = 0; b < static_cast<BodyIndex>(origins_.size()); ++b)
      blocked |= is_between(b);
    if (blocked || !model.letsMeet(pair.sphere, pair.other)) continue;

    const auto& a = model.bodies[pair.sphere].settings;
    const auto& b = model.bodies[pair.other].settings;
    const CouplerGains gains =
        computeShare(pair.gains, model.fullContactShare(pair.sphere, pair.other));
    Contact contact{pair.sphere, pair.other, gains, other >= sphere ? 1.0 : -1.0, 0.0, gains};
    const Vec3 towards = contact.side * axis_;  // from the sphere to the other
    contact.clearance =
        std::abs(other - sphere) - computeExtent(a, towards) - computeExtent(b, -towards);
    if (std::abs(contact.clearance) < kPlacementRounding) contact.clearance = 0.0;
    contact.full_clearance = contact.clearance;
    contacts_.push_back(contact);
  }
  if (contacts_.size() > kMaxContacts)
    throw std::invalid_argument("a guided island has " + std::to_string(contacts_.size()) +
                                " contacts, at most " + std::to_string(kMaxContacts) +
                                " are possible; leave the guide off or share fewer objects");

  // One map per mode: springs and dampers of all couplers and of the contacts that push. The mode
  // in which all push has the highest frequency.
  has_maps_ = contacts_.size() <= kMaxMappedContacts;
  const unsigned all = (1u << contacts_.size()) - 1u;
  const auto n = static_cast<Eigen::Index>(movers_.size());
  Eigen::VectorXd mass(n);
  Eigen::MatrixXd base_damping = Eigen::MatrixXd::Zero(n, n), base_stiffness = base_damping;
  for (Eigen::Index i = 0; i < n; ++i) {
    const ModelBody& body = model.bodies[movers_[static_cast<std::size_t>(i)]];
    mass(i) = body.settings.mass;
    mapped_.push_back({body.settings.mass, body.settings.damping});
    base_damping(i, i) = body.settings.damping;
  }
  for (const ModelCoupler& coupler : model.couplers) {
    const Eigen::Index i = freedom_[coupler.follower];
    if (i < 0) continue;
    base_stiffness(i, i) += coupler.settings.linear.stiffness;
    base_damping(i, i) += coupler.settings.linear.damping;
  }
  double max_frequency = 0.0;
  for (unsigned mode = has_maps_ ? 0u : all; n > 0 && mode <= all; ++mode) {
    Eigen::MatrixXd damping = base_damping, stiffness = base_stiffness;
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      if (!(mode >> c & 1u)) continue;
      const Contact& contact = contacts_[c];
      const int a = freedom_[contact.sphere];
      const int b = freedom_[contact.other];
      const auto couple = [&](Eigen::MatrixXd& matrix, double gain) {
        if (a >= 0) matrix(a, a) += gain;
        if (b >= 0) matrix(b, b) += gain;
        if (a >= 0 && b >= 0) matrix(a, b) -= gain, matrix(b, a) -= gain;
      };
      couple(stiffness, contact.gains.stiffness);
      couple(damping, contact.gains.damping);
    }
    LinearMap map(period_, mass, damping, stiffness);
    max_frequency = std::max(max_frequency, map.maxFrequency());
    if (has_maps_) maps_.push_back(std::move(map));
  }
  // A contact lasts about half an oscillation; check several times in each.
  while (coarsest_level_ < 16 && std::ldexp(period_, -coarsest_level_) * max_frequency > 0.5)
    ++coarsest_level_;

  series_ = LinearSeries(movers_.size());
  refit(model);
  state_.resize(2 * movers_.size());
  next_.resize(2 * movers_.size());
  u_.resize(movers_.size());
  w_.resize(movers_.size());
  driven_x_.resize(origins_.size());
  driven_v_.resize(origins_.size());
  driven_rate_.resize(origins_.size());
}

void SlotMotion::refit(const IslandModel& model) noexcept {
  uses_series_ = !has_maps_;
  for (const ModelCoupler& coupler : model.couplers) uses_series_ |= coupler.share != 1.0;
  for (const ModelBody& body : model.bodies)
    uses_series_ |= body.is_ghost || body.contact_share != body.settings.contact_share ||
                    body.extra_damping != 0.0;
  for (Contact& contact : contacts_) {
    const bool meets =
        !model.bodies[contact.sphere].is_ghost && !model.bodies[contact.other].is_ghost;
    const double share = model.contactShare(contact.sphere, contact.other) /
                         model.fullContactShare(contact.sphere, contact.other);
    contact.gains = meets ? computeShare(contact.full_gains, share) : CouplerGains{};
  }
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const ModelBody& body = model.bodies[movers_[i]];
    uses_series_ |=
        body.settings.mass != mapped_[i].mass || body.settings.damping != mapped_[i].damping;
    series_.setInverseMass(i, body.is_ghost ? 0.0 : body.inverse_mass);
  }
}

void SlotMotion::recall(const IslandModel& model) noexcept {
  for (Contact& contact : contacts_)
    contact.clearance =
        contact.full_clearance + model.memory.allowance({contact.sphere, contact.other, 0});
}

void SlotMotion::tieSeries(const IslandModel& model, unsigned mode) noexcept {
  series_.clearMatrices();
  for (std::size_t i = 0; i < movers_.size(); ++i)
    series_.tie(i, 0.0, model.bodies[movers_[i]].damping());
  for (const ModelCoupler& coupler : model.couplers) {
    const int i = freedom_[coupler.follower];
    if (i < 0) continue;
    const CouplerGains& gains = coupler.now.linear;
    series_.tie(static_cast<std::size_t>(i), gains.stiffness, gains.damping);
  }
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    if (!(mode >> c & 1u)) continue;
    const CouplerGains& gains = contacts_[c].gains;
    const int a = freedom_[contacts_[c].sphere], b = freedom_[contacts_[c].other];
    if (a >= 0 && b >= 0)
      series_.tie(static_cast<std::size_t>(a), static_cast<std::size_t>(b), gains.stiffness,
                  gains.damping);
    else if (a >= 0 || b >= 0)
      series_.tie(static_cast<std::size_t>(std::max(a, b)), gains.stiffness, gains.damping);
  }
}

double SlotMotion::computeOverlap(const IslandModel& model, BodyIndex body) const noexcept {
  double deepest = 0.0;
  for (const Contact& contact : contacts_) {
    if (contact.sphere != body && contact.other != body) continue;
    const BodyIndex partner = contact.sphere == body ? contact.other : contact.sphere;
    if (model.bodies[partner].is_ghost) continue;
    deepest = std::max(deepest,
                       overlap(model, contact).depth + contact.clearance - contact.full_clearance);
  }
  return deepest;
}

double SlotMotion::displacement(const ModelBody& body, BodyIndex index) const noexcept {
  return axis_.dot(body.state.p_W - origins_[index]);
}

SlotMotion::Overlap SlotMotion::overlap(const IslandModel& model,
                                        const Contact& contact) const noexcept {
  const ModelBody& a = model.bodies[contact.sphere];
  const ModelBody& b = model.bodies[contact.other];
  const double depth =
      contact.side * (displacement(a, contact.sphere) - displacement(b, contact.other));
  return {depth - contact.clearance, contact.side * axis_.dot(a.state.v_W - b.state.v_W)};
}

double SlotMotion::computeContactForce(const IslandModel& model, BodyIndex body) const noexcept {
  double force = 0.0;
  for (const Contact& contact : contacts_) {
    if (contact.sphere != body && contact.other != body) continue;
    const Overlap now = overlap(model, contact);
    const double push =
        contact.side * tandem::computeContactForce(contact.gains, now.depth, now.rate);
    force += contact.other == body ? push : -push;
  }
  return force;
}

SlotMotion::Overlap SlotMotion::overlapAhead(const Contact& contact, const double* state,
                                             double ahead) const noexcept {
  const std::size_t n = movers_.size();
  const auto position = [&](BodyIndex b) {
    const auto i = b;
    return freedom_[i] >= 0 ? state[freedom_[i]] : driven_x_[i] + driven_rate_[i] * ahead;
  };
  const auto velocity = [&](BodyIndex b) {
    const auto i = b;
    return freedom_[i] >= 0 ? state[n + freedom_[i]] : driven_v_[i];
  };
  return {contact.side * (position(contact.sphere) - position(contact.other)) - contact.clearance,
          contact.side * (velocity(contact.sphere) - velocity(contact.other))};
}

unsigned SlotMotion::findMode(const double* state, double ahead) const noexcept {
  unsigned mode = 0;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Overlap o = overlapAhead(contacts_[c], state, ahead);
    if (tandem::computeContactForce(contacts_[c].gains, o.depth, o.rate) > 0.0) mode |= 1u << c;
  }
  return mode;
}

void SlotMotion::gather(const IslandModel& model) noexcept {
  const std::size_t n = movers_.size();
  for (std::size_t b = 0; b < origins_.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    const double x = displacement(body, static_cast<BodyIndex>(b));
    const double v = axis_.dot(body.state.v_W);
    if (freedom_[b] >= 0) {
      state_[freedom_[b]] = x;
      state_[n + freedom_[b]] = body.is_ghost ? 0.0 : v;
    } else {
      driven_x_[b] = x;
      driven_v_[b] = v;
      driven_rate_[b] = body.settings.motion == Motion::kPrescribed ? v : 0.0;
    }
  }
}

void SlotMotion::computeInputs(const IslandModel& model, unsigned mode) noexcept {
  if (uses_series_) tieSeries(model, mode);
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    u_[i] = axis_.dot(model.bodies[movers_[i]].f_external_W);
    w_[i] = 0.0;
  }
  for (const ModelCoupler& coupler : model.couplers) {
    const auto follower = coupler.follower;
    if (freedom_[follower] < 0) continue;
    u_[freedom_[follower]] +=
        coupler.now.linear.stiffness * axis_.dot(coupler.target.p_W - origins_[follower]) +
        coupler.now.linear.damping * axis_.dot(coupler.target.v_W);
  }
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    if (!(mode >> c & 1u)) continue;
    const Contact& contact = contacts_[c];
    const double offset = contact.side * contact.gains.stiffness * contact.clearance;
    // Input part of the push: the clearance, and a partner without a degree of freedom.
    const auto drive = [&](BodyIndex pushed, BodyIndex partner, double sign) {
      const int i = freedom_[pushed];
      if (i < 0) return;
      const auto p = partner;
      u_[i] += sign * offset;
      if (freedom_[p] >= 0) return;
      u_[i] += contact.gains.stiffness * driven_x_[p] + contact.gains.damping * driven_v_[p];
      w_[i] += contact.gains.stiffness * driven_rate_[p];
    };
    drive(contact.other, contact.sphere, -1.0);
    drive(contact.sphere, contact.other, 1.0);
  }
}

/// True if a contact is made and broken (or the reverse) between two states a step `h` apart. Its
/// overlap then has an extremum on the other side. The overlap is the cubic that fits both ends.
bool SlotMotion::hidesTouch(unsigned mode, double h) const noexcept {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const double side = (mode >> c & 1u) != 0 ? -1.0 : 1.0;
    const Overlap from = overlapAhead(contacts_[c], state_.data(), 0.0);
    const Overlap to = overlapAhead(contacts_[c], next_.data(), h);
    if (!(side * from.rate > 0.0 && side * to.rate < 0.0)) continue;
    // Time at which the linearly interpolated rate is zero.
    const double s = from.rate / (from.rate - to.rate), t = 1.0 - s;
    const double top = t * t * ((1.0 + 2.0 * s) * from.depth + s * h * from.rate) +
                       s * s * ((1.0 + 2.0 * t) * to.depth - t * h * to.rate);
    if (side * top > 0.0) return true;
  }
  return false;
}

SlotMotion::Step SlotMotion::tryStep(unsigned& mode, int level, bool may_change) noexcept {
  const double h = std::ldexp(period_, -level);
  if (uses_series_)
    series_.step(h, state_.data(), u_.data(), w_.data(), next_.data());
  else
    maps_[mode].step(level, state_.data(), u_.data(), w_.data(), next_.data());
  const unsigned mode_after = findMode(next_.data(), h);
  if (!may_change) {
    if (mode_after != mode) return Step::kCrossesEvent;
    if (level < coarsest_level_ + kLevelsOfHiddenTouch && hidesTouch(mode, h))
      return Step::kHidesTouch;
  }
  mode = mode_after;
  state_.swap(next_);
  for (std::size_t b = 0; b < driven_x_.size(); ++b) driven_x_[b] += driven_rate_[b] * h;
  for (std::size_t i = 0; i < u_.size(); ++i) u_[i] += w_[i] * h;
  return Step::kTaken;
}

void SlotMotion::advanceMovers(const IslandModel& model, double dt) noexcept {
  constexpr int kFinest = LinearMap::kLevels - 1;
  // Chattering contacts are not followed forever: after this many events a step may hide one.
  int events_left = 64;
  enum class Search {
    kNone,        // no event in sight
    kDescending,  // an event is in the next T/2^(level-1): half steps up to it
    kCrossing,    // the event is within rounding of the state: growing steps across it
  } search = Search::kNone;
  int level = coarsest_level_;

  unsigned mode = findMode(state_.data(), 0.0);
  computeInputs(model, mode);
  for (std::uint64_t left = countParts(dt, period_); left > 0;) {
    while (kPartsPerPeriod >> level > left) ++level;
    const unsigned mode_before = mode;
    const bool may_change = level == kFinest || search == Search::kCrossing || events_left == 0;
    const Step step = tryStep(mode, level, may_change);
    if (step != Step::kTaken) {
      if (step == Step::kCrossesEvent) search = Search::kDescending;
      ++level;
      continue;
    }
    left -= kPartsPerPeriod >> level;
    if (mode != mode_before) {
      computeInputs(model, mode);
      if (events_left > 0) --events_left;
      search = Search::kNone;
    } else if (search == Search::kDescending) {
      if (level == kFinest)
        search = Search::kCrossing;
      else
        ++level;
    }
    if (search == Search::kCrossing && --level <= coarsest_level_) search = Search::kNone;
    if (search == Search::kNone) level = coarsest_level_;
  }
}

void SlotMotion::advance(IslandModel& model, double dt) noexcept {
  gather(model);
  if (movers_.empty()) {
    for (std::size_t b = 0; b < driven_x_.size(); ++b) driven_x_[b] += driven_rate_[b] * dt;
  } else {
    advanceMovers(model, dt);
  }
  scatter(model);
}

void SlotMotion::scatter(IslandModel& model) const noexcept {
  const std::size_t n = movers_.size();
  for (std::size_t b = 0; b < origins_.size(); ++b) {
    if (model.bodies[b].is_ghost) continue;
    RigidState& state = model.bodies[b].state;
    const bool moves = freedom_[b] >= 0;
    const double x = moves ? state_[freedom_[b]] : driven_x_[b];
    if (moves) state.v_W = axis_ * state_[n + freedom_[b]];
    if (moves || driven_rate_[b] != 0.0) state.p_W = origins_[b] + axis_ * x;
  }
}

}  // namespace tandem
