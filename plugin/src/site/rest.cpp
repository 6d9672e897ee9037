#include "site/rest.h"

namespace tandem {
namespace {

/// A body may sleep after standing still for this many host steps.
constexpr int kStepsToPark = 4;

/// Objects farther away than this do not support a body at rest [m].
constexpr double kWatchMargin = 0.04;

}  // namespace

void Rest::parkIfItStood(SiteBody& body) noexcept {
  HandOver& step = body.step;
  if (step.was_parked) return;
  step.steps_stood = step.stands && step.hit.isZero() ? step.steps_stood + 1 : 0;
  if (step.steps_stood < kStepsToPark || !step.may_park) return;
  body.bullet->park();
  if (body.bullet->isParked()) ++log_.counters.bodies_parked;
}

void Rest::unpark(SiteBody& body) noexcept {
  body.bullet->unpark();
  noteWoken(body);
}

void Rest::noteWoken(SiteBody& body) noexcept {
  body.step.steps_stood = 0;
  ++log_.counters.bodies_woken;
}

bool Rest::looksQuiet() const noexcept {
  return may_be_quiet_ && (looks_.isEmpty() || watch_.isGravityUnchanged()) &&
         looks_.isUndisturbed() && watch_.isUnchanged();
}

bool Rest::staysQuiet() noexcept {
  if (!is_quiet_) return false;
  may_be_quiet_ = looks_.areAsleep();
  return may_be_quiet_;
}

void Rest::mark(const Island& island, const Vec3& hand_W) noexcept {
  mark_.set(island);
  is_marked_ = island.isAsleep();
  hand_W_ = hand_W;
}

void Rest::fallQuiet(const Bodies& bodies) {
  may_be_quiet_ = is_marked_;
  if (!may_be_quiet_) return;
  sleepers_.clear();
  bodies.forEach([&](const SiteBody& body) { sleepers_.push_back(body.bullet->asRigid()); });
  may_be_quiet_ = looks_.remember(sleepers_);
  if (!may_be_quiet_) return;
  watch_.remember(sleepers_, hand_W_, hip_radius_ + kWatchMargin);
}

}  // namespace tandem
