#include "session/session.h"

#include <utility>

#include "tandem/coordination/link.h"
#include "tandem/coordination/passivity_observer.h"

#include "world/received_object.h"

namespace tandem::view {
namespace {

/// Between two looks, at least [s].
constexpr double kLookPeriod = 1.0 / 65.0;

LinkState findTroubledLink(const Site& site) {
  for (int remote = 0; remote < site.remoteCount(); ++remote)
    if (site.linkState(remote) != LinkState::kLive) return site.linkState(remote);
  return LinkState::kLive;
}

}  // namespace

std::shared_ptr<const SessionLook> Session::look() const {
  const std::lock_guard lock(mutex_);
  return look_;
}

void Session::publish(std::shared_ptr<const SessionLook> look) {
  const std::lock_guard lock(mutex_);
  look_.swap(look);
}

void Session::showDetails(const WorldDetails& details) {
  const std::lock_guard lock(mutex_);
  details_ = details;
}

WorldDetails Session::details() const {
  const std::lock_guard lock(mutex_);
  return details_;
}

std::vector<std::string> Session::notes() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> all = warnings_;
  all.insert(all.end(), notes_.begin(), notes_.end());
  return all;
}

void Session::tell(const std::vector<std::string>& notes) {
  const std::lock_guard lock(mutex_);
  notes_ = notes;
}

void Session::warn(const std::vector<std::string>& warnings) {
  const std::lock_guard lock(mutex_);
  warnings_ = warnings;
}

bool Session::goesOn() const {
  const std::lock_guard lock(mutex_);
  if (problem_) std::rethrow_exception(problem_);
  return !has_ended_;
}

void Session::liveToTheEnd(const std::function<void()>& live) {
  std::exception_ptr problem;
  try {
    live();
  } catch (...) {
    problem = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  problem_ = problem;
  has_ended_ = true;
}

bool Session::isLookDue(double time) noexcept {
  if (time < next_look_) return false;
  next_look_ = time + kLookPeriod;
  return true;
}

std::optional<RigidState> Session::lookAt(Site& site, SessionLook& look) {
  std::optional<RigidState> received;
  site.betweenTicks([&] {
    look.hip_W = site.hip().p_W;
    look.force_W = site.force();
    look.link = findTroubledLink(site);
    look.status = site.status();
    look.energy = site.passivity().available();
    if (site.objectCount() == 0) return;
    look.object_W = site.object(0).p_W;
    received = demos::findFarthestCopy(site);
  });
  return received;
}

}  // namespace tandem::view
