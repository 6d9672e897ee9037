#include "session/session.h"

#include <utility>

#include "tandem/coordination/passivity_observer.h"

namespace tandem::view {

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

void Session::lookAt(Site& site, SessionLook& look) {
  site.betweenTicks([&] {
    look.hip_W = site.hip().p_W;
    look.force_W = site.force();
    look.link = site.linkState(0);
    look.status = site.status();
    look.energy = site.passivity().available();
    if (site.objectCount() > 0) look.object_W = site.object(0).p_W;
  });
}

}  // namespace tandem::view
