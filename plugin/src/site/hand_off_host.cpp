#include "site/hand_off_step.h"

// Hand-off in the host's thread. Work on the island runs where the ticks run: once on the way in
// and once on the way out.

namespace tandem {
namespace {

/// A caller that has not ticked for this long has stopped [s].
constexpr double kLongestPause = 0.25;

}  // namespace

void HandOffStep::before(double dt) noexcept {
  if (isWaiting()) return;
  if (hasNoTicks()) return leaveAlone(dt);
  is_alone_ = false;
  const bool looks_quiet = dt == site_.clock.step() && site_.rest.looksQuiet() &&
                           !site_.surroundings.mayBodiesBeBack() &&
                           !site_.surroundings.joints().hasNews();
  if (!looks_quiet) {
    if (!site_.settings.guide) site_.surroundings.lookAtFrames(dt);
    if (!findChanges()) {
      site_.rest.disturb();
      return site_.desk.run([&] { site_.passStepWithout(dt); });
    }
    renewObjects(dt);
    lookAtBodies(dt);
    lookAroundNews();
  }
  site_.desk.run([&] { goIn(dt, looks_quiet); });
  if (site_.rest.isQuiet()) return;
  giveBack();
  handOff(dt);
  site_.press.show(dt);
  site_.surroundings.joints().switchOff();
}

void HandOffStep::after(double dt) noexcept {
  site_.surroundings.joints().switchOn();
  site_.press.takeOut();
  if (isWaiting()) return wait(dt);
  if (is_alone_) return site_.desk.run([&] { site_.clock.endStep(dt); });
  if (site_.rest.staysQuiet() && !site_.surroundings.isAnythingComing()) {
    ++site_.log.counters.host_steps_skipped;
    return site_.desk.run([&] {
      site_.clock.endStep(dt);
      site_.timeline.announceAfterNow(site_.clock.time() + dt, dt);
    });
  }
  site_.rest.disturb();
  if (!findChanges()) return site_.desk.run([&] { site_.clock.endStep(dt); });
  takeBack(dt);
  showPuts();
  site_.bodies.forEachPresent([&](SiteBody& body) { site_.rest.parkIfItStood(body); });
  if (!site_.ticksInHostStep()) site_.surroundings.lookAtDriven(step_end_);
  site_.objects.findReturned();
  // With a haptic thread the island's mirror is as old as Bullet's step.
  site_.surroundings.look(dt, step_end_, site_.desk.isOpen() ? dt : 0.0);
  site_.press.look(dt);
  site_.desk.run([&] { goOut(dt); });
  site_.bodies.forEachPresent([](SiteBody& body) {
    if (body.step.shift.moved) body.bullet->place(body.step.end);
  });
  site_.surroundings.placeArms();
  giveBack();
  lookFarther();
  site_.surroundings.showContacts();
  ++site_.log.counters.searches;
  fallQuiet();
}

/// True if nobody ticks any more: a loop has been stopped, or the caller stays away.
bool HandOffStep::hasNoTicks() const noexcept {
  if (site_.ticksInHostStep() || site_.desk.isOpen() || site_.settings.guide) return false;
  const double most = site_.desk.wasEverOpen() ? site_.clock.expectedStep() : kLongestPause;
  return site_.timeline.hasBegun() && site_.clock.time() - site_.timeline.time() > most;
}

/// Leaves all bodies to Bullet until somebody ticks again. The island would let them hang.
void HandOffStep::leaveAlone(double dt) noexcept {
  if (!is_alone_) {
    is_alone_ = true;
    leaveNeighbours();
    site_.objects.leaveAll();
    site_.objects.takeLeaving();
    site_.objects.giveBack();
  }
  site_.followHostClock(dt);
}

/// Marks bodies that the island must leave. False if the site has to stop: no body can leave a
/// guide.
bool HandOffStep::findChanges() noexcept {
  if (site_.settings.guide) return site_.areBodiesPresent();
  site_.surroundings.findMissing();
  if (site_.objects.findChanged()) site_.rest.disturb();
  return true;
}

/// Takes objects out that the host changed, and holds those again that may still be held: Bullet
/// makes no step with them.
void HandOffStep::renewObjects(double dt) {
  if (site_.objects.areLeaving()) {
    site_.desk.run([&] {
      site_.surroundings.takeLeaving();
      site_.objects.takeLeaving();
    });
    giveBack();
  }
  if (!site_.objects.findReturned()) return;
  site_.surroundings.searchObstacles(true);
  site_.desk.run([&] {
    site_.surroundings.takeObstacles();
    site_.objects.take(dt);
    site_.surroundings.catchUp();
  });
}

void HandOffStep::giveBack() {
  site_.surroundings.giveBack();
  site_.objects.giveBack();
}

/// False if another number of sites shares the body's mass now.
bool HandOffStep::hasItsShare(const SiteBody& body) noexcept {
  const HapticBody* rigid = body.bullet->asRigid();
  return !rigid || rigid->massShare() == body.step.mass_share;
}

/// Objects that the host has put to sleep stop where they are, as in Bullet.
void HandOffStep::stopSleepers() noexcept {
  for (SharedObject& object : site_.bodies.objects) {
    SiteBody& body = object.body;
    if (!body.is_held || body.is_leaving || !object.bullet->wasPutToSleep()) continue;
    body.step.end = object.bullet->stop();
    body.step.is_stopped = true;
  }
}

/// Reads how the host changed its bodies for its coming step.
void HandOffStep::lookAtBodies(double dt) noexcept {
  if (!site_.settings.guide) stopSleepers();
  site_.surroundings.lookAtArms(dt);
  site_.bodies.forEachPresent([&](SiteBody& body) {
    HostBody& bullet = *body.bullet;
    const bool has_share = hasItsShare(body);
    if (bullet.isParked()) {
      if (has_share && bullet.isUndisturbed() && !bullet.hasMissedWorldGravity()) return;
      site_.rest.unpark(body);
    }
    body.step.is_told = true;
    body.step.change = bullet.takeHostChanges(dt);
    if (!has_share) bullet.asRigid()->setMassShare(body.step.mass_share);
    body.step.f_gravity_W = bullet.gravityForce();
  });
  site_.surroundings.lookAtDamping();
}

/// The island has to know before it goes on what is around a body that the host put elsewhere, and
/// how the host changed what bodies touch.
void HandOffStep::lookAroundNews() {
  if (site_.settings.guide) return;
  bool is_any = site_.surroundings.hasNews();
  for (const SharedObject& object : site_.bodies.objects) {
    const HandOver& step = object.body.step;
    if (!object.body.is_held || object.body.is_leaving || !step.is_told || !step.change.moved ||
        step.change.offset_W.norm() < object.bounding_radius)
      continue;
    site_.surroundings.expectAt(object.body.index, object.bullet->state());
    is_any = true;
  }
  if (!is_any) return;
  site_.surroundings.searchObstacles(true);
  site_.desk.run([&] { site_.surroundings.takeObstacles(); });
}

/// Gives Bullet the states of its bodies at the end of the step.
void HandOffStep::handOff(double dt) noexcept {
  for (Peer& peer : site_.peers)
    if (btRigidBody* rigid = peer.proxy.findRigid())
      setNativeGhost(*rigid, peer.proxy.body.step.is_ghost);
  site_.bodies.forEachPresent([&](SiteBody& body) {
    HostBody& bullet = *body.bullet;
    body.step.stands = bullet.standsAt(body.step.end);
    if (bullet.isParked()) {
      if (body.step.stands) return;
      site_.rest.unpark(body);
    }
    if (site_.clock.hasJumped()) bullet.setState(computeStart(body.step.end, dt));
    bullet.handOff(body.step.end, dt, body.step.foreseen.mean);
    ++site_.log.counters.bodies_handed_off;
  });
  site_.surroundings.handOffArms(dt);
}

/// Shows Bullet where peers' resets put objects: what is around is searched there.
void HandOffStep::showPuts() noexcept {
  site_.bodies.forEachPresent([&](SiteBody& body) {
    if (!body.step.is_put) return;
    if (body.bullet->isParked()) site_.rest.unpark(body);
    body.step.forgetReaction();
    body.step.end = body.step.put;
    body.bullet->setState(body.step.put);
    site_.surroundings.expectAt(body.index, body.step.put);
  });
}

/// Reads what Bullet's solver did: joints, and contact with bodies that the island does not hold.
void HandOffStep::takeBack(double dt) {
  site_.surroundings.restoreArms();
  site_.bodies.forEachPresent([&](SiteBody& body) { restore(body); });
  site_.press.finish(dt);
  site_.bodies.forEachPresent([&](SiteBody& body) {
    HandOver& step = body.step;
    HostChange& change = step.shift;
    // A body that sleeps on lets its supports hold it.
    if (body.bullet->isParked()) change = {};
    const SupportRows::Given support =
        body.bullet->isParked() ? SupportRows::Given{} : site_.press.computeSupport(body);
    step.is_supported = !support.all.isZero();
    step.lasting_support = support.lasting;
    const Momentum& foreseen = step.foreseen.sum;
    step.reaction = {dropRounding(change.impulse_W), dropRounding(change.angular_impulse_W)};
    step.hit = {dropRounding(change.impulse_W - foreseen.linear_W),
                dropRounding(change.angular_impulse_W - foreseen.angular_W)};
  });
}

void HandOffStep::restore(SiteBody& body) noexcept {
  HostChange& change = body.step.shift;
  change = {};
  HostBody& bullet = *body.bullet;
  body.step.was_parked = bullet.isParked();
  body.step.was_near_awake = body.step.was_parked && !bullet.isAsleep();
  if (!body.step.was_parked) {
    change = bullet.restore();
  } else if (bullet.wakeIfHit(change)) {
    site_.rest.noteWoken(body);
  }
}

/// A new neighbour may meet stretched springs. With a haptic thread the obstacles found now act
/// from the next way in.
void HandOffStep::lookFarther() {
  if (!site_.surroundings.mustLookFarther()) return;
  site_.surroundings.lookFarther();
  if (!site_.desk.isOpen()) site_.surroundings.takeObstacles();
}

/// Called at the end of a complete host step: the next one is quiet if all bodies sleep.
void HandOffStep::fallQuiet() {
  bool all_parked = true;
  site_.bodies.forEachPresent(
      [&](const SiteBody& body) { all_parked &= body.bullet->isParked() && hasItsShare(body); });
  if (!all_parked || site_.objects.hasLeft()) return;
  // A kinematic body may start to move at any step, and that wakes nothing.
  if (site_.surroundings.isAnythingDriven()) return;
  site_.rest.fallQuiet(site_.bodies);
}

}  // namespace tandem
