#include <algorithm>
#include <cmath>

#include "tandem/falcon/monotonic_clock.h"

#include "refusal.h"
#include "session.h"

namespace tandem::pybullet {
namespace {

/// Largest difference of equal states [m, m/s, rad/s, and of quaternions].
constexpr double kSame = 1e-9;

bool areNear(const double* a, const double* b, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    if (!(std::abs(a[i] - b[i]) <= kSame)) return false;
  }
  return true;
}

bool isTurnedAlike(const double a[4], const double b[4]) {
  const double product = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  return 1.0 - std::abs(product) < kSame;
}

bool arePosesNear(const TandemState& a, const TandemState& b) {
  return areNear(a.position, b.position, 3) && isTurnedAlike(a.orientation, b.orientation);
}

bool areNear(const TandemState& a, const TandemState& b) {
  return arePosesNear(a, b) && areNear(a.velocity, b.velocity, 3) &&
         areNear(a.angular_velocity, b.angular_velocity, 3);
}

/// Time in which a body at velocity `v` covers the way between two states [s].
double computeTimeMoved(const TandemState& from, const TandemState& to, const double v[3]) {
  double along = 0.0;
  for (std::size_t i = 0; i < 3; ++i) along += (to.position[i] - from.position[i]) * v[i];
  return along / (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

}  // namespace

void Session::warn(const std::string& text) {
  constexpr std::size_t kMost = 100;
  if (warnings_.size() < kMost) warnings_.push_back(text);
}

void Session::end(const std::string& why) {
  is_between_ = false;
  ended_ = why;
}

void Session::runSafely(void (Session::*part)()) noexcept {
  try {
    try {
      (this->*part)();
    } catch (const Refusal& why) {
      end(why.what());
    }
  } catch (...) {
    is_between_ = false;
    ended_ = "out of memory";  // short enough for a string without heap memory
  }
}

BorrowedBody::Presence Session::look(BorrowedBody& body) {
  std::string notice;
  const BorrowedBody::Presence presence = body.look(engine_, notice);
  if (!notice.empty()) warn(notice);
  return presence;
}

// Checks one body per step, so that the cost does not grow with their number.
void Session::lookAtOne() {
  const std::size_t all = moving_.size() + standing_.size();
  if (all == 0) return;
  next_look_ = (next_look_ + 1) % all;
  if (next_look_ < moving_.size()) {
    keep(next_look_);
    return;
  }
  const std::size_t place = next_look_ - moving_.size();
  if (!keepObstacle(place)) return;
  Standing& one = standing_[place];
  TandemState pose{};
  if (!engine_.readState(one.body.number(), pose)) return;
  if (arePosesNear(pose, one.pose)) return;
  one.pose = pose;
  for (std::size_t i = 0; i < one.ids.size(); ++i) {
    const TandemState state = computePieceState(pose, one.pieces[i]);
    check(tandem_world_set_state(world_.get(), one.ids[i], &state));
  }
}

void Session::preTick() noexcept {
  if (!site_ || !ended_.empty()) return;
  runSafely(&Session::begin);
}

void Session::postTick() noexcept {
  if (!is_between_) return;
  is_between_ = false;
  runSafely(&Session::finish);
}

/// Reads the states of all moving bodies, and loses those that were removed.
void Session::readMoving() {
  for (std::size_t i = 0; i < moving_.size() && ended_.empty();) {
    Moving& one = moving_[i];
    if (!engine_.readState(one.body.number(), now_[i])) {
      lose(i, BorrowedBody::Presence::kRemoved);
      continue;
    }
    if (one.has_stood) explainStanding(one, now_[i]);
    if (areNear(now_[i], one.set) || keep(i)) ++i;
  }
}

void Session::begin() {
  const double gravity[3] = {parameters_.gravity[0], parameters_.gravity[1],
                             parameters_.gravity[2]};
  const std::optional<EngineParameters> asked = engine_.readParameters();
  if (!asked) return end("PyBullet does not tell its time step");
  parameters_ = *asked;
  if (!std::equal(gravity, gravity + 3, parameters_.gravity)) {
    check(tandem_world_set_gravity(world_.get(), parameters_.gravity));
  }
  lookAtOne();
  readMoving();
  if (!ended_.empty()) return;
  if (mesh_) check(tandem_mesh_poll(mesh_.get(), readMonotonicClock()));
  check(tandem_world_begin_step(world_.get(), parameters_.step, parameters_.gravity, ids_.size(),
                                ids_.data(), now_.data(), told_.data()));
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    TandemState told = told_[i];
    std::copy_n(now_[i].orientation, 4, told.orientation);
    moving_[i].body.makeReadyToTurn(parameters_.step, told);
    engine_.writeVelocities(moving_[i].body.number(), told);
    moving_[i].set = now_[i];
  }
  is_between_ = true;
}

// Warns if PyBullet's motion does not fit the step: Bullet moves a body by its new velocity times
// dt.
void Session::watchStep(Moving& one, const TandemState& after) {
  if (has_warned_of_step_) return;
  const double* const v = after.velocity;
  if (std::hypot(v[0], v[1], v[2]) * parameters_.step < 1e-6) return;
  const double step = computeTimeMoved(one.set, after, v);
  if (std::abs(step - parameters_.step) < 1e-3 * parameters_.step) return;
  one.has_stood = std::abs(step) < 1e-3 * parameters_.step;
  if (one.has_stood) return;  // the next step shows why
  has_warned_of_step_ = true;
  warn("PyBullet moved a body for " + std::to_string(step) + " s in a step of " +
       std::to_string(parameters_.step) + " s: where shared bodies are is not exact");
}

// A deformable world calls the post-tick before it moves its bodies, and moves them after it.
void Session::explainStanding(Moving& one, const TandemState& now) {
  one.has_stood = false;
  const double* const v = one.set.velocity;
  if (std::hypot(v[0], v[1], v[2]) * parameters_.step < 1e-6) return;
  const double moved = computeTimeMoved(one.set, now, v) / parameters_.step;
  if (moved > 0.5 && moved < 1.5) {
    return end(
        "PyBullet's world is deformable and moves bodies when its step is over, so nothing can be "
        "shared in it: `resetSimulation` without RESET_USE_DEFORMABLE_WORLD");
  }
  has_warned_of_step_ = true;
  warn("body " + std::to_string(one.body.number()) +
       " has a velocity, but PyBullet did not move it: is it static or kinematic now? It is not "
       "where it is felt");
}

void Session::finish() {
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    Moving& one = moving_[i];
    one.is_gone = !engine_.readState(one.body.number(), now_[i]);
    if (one.is_gone) {
      now_[i] = one.set;
    } else {
      watchStep(one, now_[i]);
      one.body.leaveOutTurn(now_[i]);
    }
  }
  check(tandem_world_end_step(world_.get(), ids_.size(), ids_.data(), now_.data(), told_.data()));
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    if (moving_[i].is_gone) continue;
    engine_.writeState(moving_[i].body.number(), told_[i]);
    moving_[i].set = told_[i];
  }
  for (std::size_t i = moving_.size(); i-- > 0;) {
    if (moving_[i].is_gone) lose(i, BorrowedBody::Presence::kRemoved);
  }
}

void Session::read(SessionReading& out) const {
  requireOpen();
  TandemReading& reading = out.reading;
  check(tandem_site_read(site_.get(), &reading, 0, nullptr, 0, nullptr, nullptr));
  out.objects.resize(reading.object_count);
  out.proxies.resize(reading.remote_count);
  out.links.resize(reading.remote_count);
  std::vector<TandemLinkState> links(reading.remote_count);
  check(tandem_site_read(site_.get(), &reading, out.objects.size(), out.objects.data(),
                         out.proxies.size(), out.proxies.data(), links.data()));
  for (std::size_t i = 0; i < out.links.size(); ++i) out.links[i] = tellLink(i, links[i]);
  if (has_ever_lost_) reading.status |= TANDEM_STATUS_BODY_MISSING;
  out.has_ended = !ended_.empty();
  if (out.has_ended) std::fill_n(reading.force, 3, 0.0);
}

/// PyBullet's number of a body in Tandem's world.
int Session::findBody(TandemBody id) const {
  for (const Moving& one : moving_)
    if (one.id == id) return one.body.number();
  for (const Standing& one : standing_)
    if (std::find(one.ids.begin(), one.ids.end(), id) != one.ids.end()) return one.body.number();
  return -1;
}

std::vector<Session::Contact> Session::contacts() const {
  requireSite();
  std::size_t count = 0;
  check(tandem_world_get_contacts(world_.get(), 0, nullptr, &count));
  std::vector<TandemContact> found(count);
  check(tandem_world_get_contacts(world_.get(), count, found.data(), &count));
  std::vector<Contact> contacts;
  contacts.reserve(count);
  for (const TandemContact& contact : found) {
    contacts.push_back({findBody(contact.a), findBody(contact.b), contact});
  }
  return contacts;
}

std::string Session::warnings() const {
  std::string text;
  if (site_) {
    std::size_t length = 0;
    check(tandem_site_warnings(site_.get(), nullptr, 0, &length));
    text.resize(length + 1);
    check(tandem_site_warnings(site_.get(), text.data(), text.size(), &length));
    text.resize(length);
  }
  const auto add = [&text](const std::string& line) {
    if (!text.empty() && text.back() != '\n') text += '\n';
    text += line;
  };
  for (const std::string& line : warnings_) add(line);
  for (const int object : lost_) {
    const std::string number = std::to_string(object);
    add("object " + number + " has no body: share one again with object=" + number);
  }
  if (!ended_.empty()) add(ended_ + ": the site has ended");
  return text;
}

}  // namespace tandem::pybullet
