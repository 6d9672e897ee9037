#include "site/hand_off_step.h"

#include <algorithm>

#include "site/teleport.h"

// The tick, and the work that the host's step hands to the ticking thread. hand_off_host.cpp has
// the host's thread.

namespace tandem {

HandOffStep::HandOffStep(SiteParts& parts) : IslandStep(parts) {
  site_.island.setContactFinder(&site_.surroundings.contactFinder());
  if (!site_.settings.guide) site_.island.setJointSource(&site_.surroundings.joints());
  if (!site_.settings.guide) site_.surroundings.addSlots(site_.settings.max_neighbours);
}

void HandOffStep::addObject(SharedObject& object) {
  if (!site_.settings.guide) site_.surroundings.addBody(object.body.index, *object.rigid);
  IslandStep::addObject(object);
}

void HandOffStep::finishSetUp() {
  site_.bodies.forEachPresent(
      [&](SiteBody& body) { site_.forces.setWeight(body, body.bullet->gravityForce()); });
  IslandStep::finishSetUp();
}

/// Moves the island over ticks that the caller left out, with their packets and host steps but
/// without a rendered force. The HIP moves steadily to the hand's present position.
void HandOffStep::makeUp(double now, double most) noexcept {
  Timeline& timeline = site_.timeline;
  if (site_.log.hasStopped()) return;
  if (now - timeline.time() > most + kSameTime) loseTime(now - most);
  if (now - timeline.time() > kSameTime) site_.hand.lead(now - timeline.time());
  while (now - timeline.time() > kSameTime) {
    const double start = timeline.time();
    timeline.startTick(start);
    site_.peers.takeInUntil(start, start);
    site_.peers.followMembers(start);
    site_.peers.followLinks(start, timeline.period(), *this);
    site_.grips.follow(start, timeline.period());
    timeline.keepStart();
    advance(start, std::min(start + timeline.period(), now));
    ++site_.log.counters.ticks_made_up;
  }
}

/// Skips lost time: nothing moves or is sent, and no host step ends in it.
void HandOffStep::loseTime(double until) noexcept {
  site_.forces.settle();
  site_.timeline.lose(until);
  site_.forces.skip();
  site_.sender.skipTo(until);
}

/// Events split the period: packets, ends of host steps, the end of the host's forces, sends.
void HandOffStep::advance(double now, double end) noexcept {
  for (;;) {
    const double event = std::min({site_.peers.nextArrival(now, end), site_.timeline.announcedEnd(),
                                   site_.forces.nextEnd(), site_.sender.due()});
    if (event >= end - kSameTime) break;
    moveTo(event);
    site_.peers.takeInUntil(event, now);
    site_.sender.sendIfDue(event, true);
  }
  moveTo(end);
  site_.hand.energy().countWorld(site_.island, site_.timeline);
}

void HandOffStep::moveTo(double until) noexcept {
  site_.timeline.moveTo(until);
  if (site_.forces.endIfDue()) site_.surroundings.joints().endTorques();
}

/// The way in: the island takes the host's changes and moves on.
void HandOffStep::goIn(double dt, bool looks_quiet) noexcept {
  if (site_.rest.begin(looks_quiet, site_.island)) return restOn(dt);
  site_.surroundings.takeLeaving();
  site_.followHostClock(dt);
  step_end_ = site_.clock.time() + dt;
  site_.clock.setStep(dt);
  site_.timeline.announce(step_end_, dt);
  passHostChanges(dt);
  if (site_.ticksInHostStep()) {
    site_.surroundings.lookAtDriven(step_end_);
    site_.surroundings.steerDriven(true);
    site_.runTicksUntil(step_end_);
  }
  findEnds();
  site_.surroundings.mirror();
}

/// The way in of a quiet step, in which nothing is known to move. Its own ticks may end the quiet.
void HandOffStep::restOn(double dt) noexcept {
  site_.followHostClock(dt);
  step_end_ = site_.clock.time() + dt;
  site_.forces.skip();
  if (!site_.ticksInHostStep()) return;
  site_.runTicksUntil(step_end_);
  if (site_.rest.stays(site_.island)) return;
  findEnds();
  site_.surroundings.mirror();
}

/// Passes the host's changes of its bodies to the island.
void HandOffStep::passHostChanges(double dt) noexcept {
  site_.bodies.forEach([&](SiteBody& body) {
    if (body.step.is_told && body.step.change.moved) moveBody(body, body.step.change);
  });
  site_.forces.pass(dt, site_.ticksInHostStep());
  takeStops();
  takeMasses();
  site_.surroundings.followDamping();
  const PayWindow window = site_.forces.findWindow(dt, site_.ticksInHostStep());
  if (site_.surroundings.joints().refresh(window)) site_.island.wake();
}

/// Moves the island's body along when the host repositions its body. Kept states for coming host
/// steps move too.
void HandOffStep::moveBody(SiteBody& body, const HostChange& change) noexcept {
  site_.timeline.changeAfter(site_.clock.time() + kClockTolerance, body.index,
                             [&](RigidState state) {
                               state.p_W += change.offset_W;
                               state.q_WB = (change.rotation_W * state.q_WB).normalized();
                               return state;
                             });
  site_.hand.energy().refill();
  const double way = change.offset_W.norm();
  // Joints and contacts of the place that it left do not go on.
  if (isTeleport(way, change.rotation_W, 0.0)) site_.forces.forgetForesight(body);
  for (SharedObject& object : site_.bodies.objects)
    if (&object.body == &body && isTeleport(way, change.rotation_W, object.bounding_radius))
      site_.peers.beginEpoch(object);
}

/// Stops objects that the host has put to sleep. They hang without weight until something wakes
/// them.
void HandOffStep::takeStops() noexcept {
  for (SharedObject& object : site_.bodies.objects) {
    SiteBody& body = object.body;
    if (!body.is_held || !body.step.is_stopped) continue;
    body.step.is_stopped = false;
    const RigidState last = site_.island.state(body.index);
    if (isTeleport(last, body.step.end, object.bounding_radius)) site_.peers.beginEpoch(object);
    site_.forces.stop(body);
    site_.timeline.put(body.index, body.step.end);
    site_.hand.energy().refill();
  }
}

/// Looks up the states of all bodies at the end of the host's step.
void HandOffStep::findEnds() noexcept {
  const std::vector<RigidState>* states = site_.timeline.findStates(step_end_);
  site_.bodies.forEach([&](SiteBody& body) {
    body.step.end = states ? (*states)[static_cast<std::size_t>(body.index)]
                           : site_.timeline.stateAt(body.index, step_end_);
    body.step.foreseen = site_.forces.takeForeseen(body, step_end_);
    body.step.is_put = false;
    body.step.is_ghost = site_.island.isGhost(body.index);
    body.step.may_park = body.load.isSettled();
  });
  for (SharedObject& object : site_.bodies.objects) {
    if (!object.awaits_put || !object.body.is_held) continue;
    object.body.step.is_put = true;
    object.body.step.put = site_.peers.findPlace(object);
  }
  findShares();
  site_.press.findContacts(step_end_);
}

/// Tells the host's thread which parts of masses its bodies have from its next step on.
void HandOffStep::findShares() noexcept {
  if (!site_.settings.membership.follows) return;
  for (SharedObject& object : site_.bodies.objects)
    object.body.step.mass_share = site_.peers.findMassShare(object.tool_of);
  for (Peer& peer : site_.peers) peer.proxy.body.step.mass_share = site_.peers.standIn().share;
}

/// Follows with the island. Velocities stay, so the copies together keep their momentum.
void HandOffStep::takeMasses() noexcept {
  for (SharedObject& object : site_.bodies.objects) {
    if (!object.body.is_held || !object.body.bullet) continue;
    if (object.bullet->massShare() == object.mass_share) continue;
    const IslandBody& body = site_.island.body(object.body.index);
    const RigidState& state = site_.island.state(object.body.index);
    site_.hand.energy().countNeighbour(body, state, -1.0);
    object.mass_share = object.bullet->massShare();
    readBody(*object.bullet, object.settings);
    site_.island.setMass(object.body.index, object.settings.mass, object.settings.inertia_B,
                         body.damping);
    site_.hand.energy().countNeighbour(body, state, 1.0);
  }
}

/// The way out: the island takes solver impulses, neighbours and obstacles.
void HandOffStep::goOut(double dt) noexcept {
  site_.clock.endStep(dt);
  if (site_.surroundings.joints().tell(dt)) site_.island.wake();
  site_.surroundings.takeContacts();
  site_.bodies.forEach([&](SiteBody& body) {
    if (!body.step.was_parked) site_.forces.forgetLate(body);
  });
  site_.forces.takeReactions(dt);
  site_.bodies.forEach([](SiteBody& body) { body.seen = body.step.end; });
  takePuts();
  site_.timeline.announceAfterNow(site_.clock.time() + dt, dt);
  if (!site_.ticksInHostStep()) site_.surroundings.steerDriven(false);
  if (!site_.desk.isOpen()) makeRoomFor(dt);
  site_.objects.take(dt);
  site_.surroundings.take();
  if (!site_.timeline.hasBegun()) return;
  site_.rest.mark(site_.island, site_.island.state(site_.hand.hip()).p_W);
  if (site_.island.isAsleep()) site_.surroundings.mirror();
}

/// Puts objects where peers' resets have them. Bullet's bodies are there already, and all around is
/// known.
void HandOffStep::takePuts() noexcept {
  for (SharedObject& object : site_.bodies.objects) {
    if (!object.body.is_held || !object.body.step.is_put) continue;
    object.body.step.is_put = false;
    site_.timeline.put(object.body.index, object.body.step.put);
    site_.peers.finishPut(object);
  }
}

}  // namespace tandem
