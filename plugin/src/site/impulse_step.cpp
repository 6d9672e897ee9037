#include "site/impulse_step.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace tandem {

void ImpulseStep::addProxy(Peer& peer, const Vec3& start_W) {
  checkStable("proxy", site_.peers.standIn().proxy.mass);
  IslandStep::addProxy(peer, start_W);
}

void ImpulseStep::checkObject(double mass) const { checkStable("shared object", mass); }

void ImpulseStep::checkStable(const char* what, double mass) const {
  const SiteSettings& settings = site_.settings;
  const double stiffness = settings.contact.stiffness + settings.coordination.stiffness;
  const double damping = settings.contact.damping + settings.coordination.damping;
  const double limit = computeInjectionStepLimit(stiffness, damping, mass);
  const double period = site_.timeline.period();
  if (period < limit) return;
  std::ostringstream message;
  message << "impulse injection is unstable for the " << what << ": the step of " << period
          << " s is above its limit of " << limit << " s for K = " << stiffness
          << " N/m, B = " << damping << " N s/m, m = " << mass
          << " kg; use hand-off, lower the gains or raise the haptic rate";
  throw std::invalid_argument(message.str());
}

void ImpulseStep::finishSetUp() {
  wrenches_.resize(static_cast<std::size_t>(site_.island.bodyCount()));
  IslandStep::finishSetUp();
}

void ImpulseStep::advance(double now, double end) noexcept {
  site_.bodies.forEach([&](SiteBody& body) {
    Wrench& wrench = wrenches_[static_cast<std::size_t>(body.index)];
    site_.island.computeWrench(body.index, wrench.f_W, wrench.t_W);
  });
  site_.sender.sendIfDue(now, false);
  site_.island.passTime(end - now);
  site_.timeline.passTo(end);
}

void ImpulseStep::showProxy(Peer& peer) noexcept {
  const BodyIndex index = *peer.user.body;
  peer.proxy.show(site_.island.state(index), site_.island.isGhost(index));
}

void ImpulseStep::before(double dt) noexcept {
  if (isWaiting()) return;
  site_.surroundings.restoreReturned();
  if (!areBodiesPresent()) return site_.passStepWithout(dt);
  const double period = site_.timeline.period();
  if (std::abs(dt - period) > 1e-3 * period) site_.log.raiseFromHost(kHostStepWrong);
  site_.followHostClock(dt);
  site_.noteTeleports();
  const double end = site_.clock.time() + dt;
  site_.clock.setStep(dt);
  site_.timeline.announce(end, dt);
  if (site_.ticksInHostStep()) site_.runTicksUntil(end);
  site_.bodies.forEach([&](SiteBody& body) {
    const Wrench& wrench = wrenches_[static_cast<std::size_t>(body.index)];
    if (site_.island.isDynamic(body.index)) body.bullet->applyWrench(wrench.f_W, wrench.t_W, dt);
  });
}

void ImpulseStep::after(double dt) noexcept {
  if (isWaiting()) return wait(dt);
  site_.clock.endStep(dt);
  if (!areBodiesPresent()) return;
  site_.bodies.forEachPresent([&](SiteBody& body) {
    if (site_.island.isDynamic(body.index)) {
      site_.island.setState(body.index, body.bullet->state());
    } else {
      body.bullet->setState(site_.island.state(body.index));
    }
  });
  site_.timeline.announceAfterNow(site_.clock.time() + dt, dt);
  makeRoomFor(dt);
  if (!site_.settings.guide) {
    site_.objects.findReturned();
    site_.objects.take(dt);
  }
  lookAround(dt);
  ++site_.log.counters.searches;
}

}  // namespace tandem
