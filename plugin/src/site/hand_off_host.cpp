#include "site/hand_off_step.h"

// The host's thread in a step with hand-off. What touches the island is asked for, once on the way
// in and once on the way out.

namespace tandem {

void HandOffStep::before(double dt) noexcept {
  if (isWaiting()) return;
  const bool looks_quiet = dt == site_.clock.step() && site_.rest.looksQuiet();
  if (!looks_quiet) {
    site_.surroundings.findMissing();
    if (!site_.areBodiesPresent()) {
      site_.rest.disturb();
      site_.desk.run([&] {
        site_.surroundings.takeLeaving();
        site_.passStepWithout(dt);
      });
      return site_.surroundings.giveBack();
    }
    lookAtBodies(dt);
  }
  site_.desk.run([&] { goIn(dt, looks_quiet); });
  if (site_.rest.isQuiet()) return;
  site_.surroundings.giveBack();
  handOff(dt);
}

void HandOffStep::after(double dt) noexcept {
  if (isWaiting()) return wait(dt);
  if (site_.rest.staysQuiet()) {
    ++site_.log.counters.host_steps_skipped;
    return site_.desk.run([&] {
      site_.clock.endStep(dt);
      site_.timeline.announceAfterNow(site_.clock.time() + dt, dt);
    });
  }
  site_.rest.disturb();
  site_.surroundings.findMissing();
  if (!site_.areBodiesPresent()) {
    site_.desk.run([&] {
      site_.surroundings.takeLeaving();
      site_.clock.endStep(dt);
    });
    return site_.surroundings.giveBack();
  }
  site_.bodies.forEachPresent([&](SiteBody& body) { takeBack(body); });
  site_.bodies.forEachPresent([&](SiteBody& body) { site_.rest.parkIfItStood(body); });
  if (!site_.ticksInHostStep()) site_.surroundings.lookAtDriven(step_end_);
  // With a haptic thread what is known of the island is as old as Bullet's step.
  site_.surroundings.look(dt, step_end_, site_.desk.isOpen() ? dt : 0.0);
  site_.desk.run([&] { goOut(dt); });
  site_.surroundings.giveBack();
  lookFarther();
  ++site_.log.counters.searches;
  fallQuiet();
}

/// What the host did to its bodies for its coming step.
void HandOffStep::lookAtBodies(double dt) noexcept {
  site_.bodies.forEachPresent([&](SiteBody& body) {
    HapticBody& bullet = *body.bullet;
    if (bullet.isParked()) {
      if (bullet.isUndisturbed() && !bullet.hasMissedWorldGravity()) return;
      site_.rest.unpark(body);
    }
    body.step.is_told = true;
    body.step.change = bullet.takeHostChanges(dt);
    body.step.f_gravity_W = bullet.gravityForce();
  });
  site_.surroundings.lookAtDamping();
}

/// Bullet gets its bodies' states at the end of the step.
void HandOffStep::handOff(double dt) noexcept {
  for (Peer& peer : site_.peers)
    if (peer.proxy.sphere && peer.proxy.sphere->isAlive())
      peer.proxy.sphere->setGhost(peer.proxy.body.step.is_ghost);
  site_.bodies.forEachPresent([&](SiteBody& body) {
    HapticBody& bullet = *body.bullet;
    body.step.stands = bullet.standsAt(body.step.end);
    if (bullet.isParked()) {
      if (body.step.stands) return;
      site_.rest.unpark(body);
    }
    if (site_.clock.hasJumped()) bullet.setState(computeStart(body.step.end, dt));
    bullet.handOff(body.step.end, dt);
    ++site_.log.counters.bodies_handed_off;
  });
}

/// What Bullet's solver did besides: contact with moving bodies that are not held.
void HandOffStep::takeBack(SiteBody& body) noexcept {
  HostChange change;
  HapticBody& bullet = *body.bullet;
  body.step.was_parked = bullet.isParked();
  body.step.was_near_awake = body.step.was_parked && !bullet.isAsleep();
  if (!body.step.was_parked) {
    change = bullet.restore();
  } else if (bullet.wakeIfHit(change)) {
    site_.rest.noteWoken(body);
  }
  body.step.hit = {dropRounding(change.impulse_W), dropRounding(change.angular_impulse_W)};
}

/// Springs may have been stretched by what was just found. With a haptic thread what is found now
/// acts from the next way in.
void HandOffStep::lookFarther() {
  if (!site_.surroundings.mustLookFarther()) return;
  site_.surroundings.lookFarther();
  if (!site_.desk.isOpen()) site_.surroundings.takeObstacles();
}

/// After a host step with everything done: the next is quiet if all sleep.
void HandOffStep::fallQuiet() {
  bool all_parked = true;
  site_.bodies.forEachPresent([&](const SiteBody& body) { all_parked &= body.bullet->isParked(); });
  // What the host moves by hand may come at any step, and wakes nobody.
  if (!all_parked || (!site_.isBare() && site_.surroundings.isAnythingDriven())) return;
  site_.rest.fallQuiet(site_.bodies);
}

}  // namespace tandem
