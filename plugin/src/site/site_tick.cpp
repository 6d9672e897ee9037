#include "site/site_impl.h"

namespace tandem {

std::uint32_t Site::Impl::tick(double now, double most_made_up) noexcept {
  if (!timeline.hasBegun()) begin(now);
  log.startTick();

  // Device sample.
  hand.read(now);
  if (!hand.isThere()) log.raise(kDeviceInvalid);
  if (now - timeline.time() > kSameTime) host_step->makeUp(now, most_made_up);
  timeline.startTick(now);
  hand.place();
  hand.countWork();

  // Packets.
  peers.takeInUntil(now, now);
  peers.followMembers(now);
  peers.followLinks(now, timeline.period(), *host_step);
  grips.follow(now, timeline.period());

  // The force of a tick is computed from its start.
  const Vec3 torque_W = hand.feelsTorque() ? grips.computeTorque() : Vec3(Vec3::Zero());
  hand.render(host_step->computeContactForce(), torque_W, peers, log.hasFault());
  if (log.recording) log.recordTick(now, hand, bodies, peers, island, !desk.isOpen());
  log.addToHash(now, hand.force(), island);
  if (!island.isAsleep() && !areAwakeFinite(island)) log.raise(kStateNotFinite);
  hand.write();

  // The island moves on.
  sender.lookForIdleness(now);
  timeline.keepStart();
  if (!log.hasStopped()) host_step->advance(now, now + timeline.period());
  timeline.endTick();
  return log.endTick();
}

/// Site time begins with the first tick.
void Site::Impl::begin(double now) noexcept {
  timeline.begin(now, clock.begin(now));
  forces.skip();
}

}  // namespace tandem
