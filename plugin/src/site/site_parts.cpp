#include "site/site_parts.h"

#include "site/teleport.h"

namespace tandem {
namespace {

SiteSettings checked(const SiteSettings& settings) {
  checkSiteSettings(settings);
  return settings;
}

IslandSettings makeIslandSettings(const SiteSettings& settings) {
  IslandSettings island;
  island.haptic_period = 1.0 / settings.haptic_rate;
  island.inner_step = settings.inner_step;
  island.guide = settings.guide;
  island.obstacle_contact = settings.contact;
  return island;
}

}  // namespace

SiteParts::SiteParts(const SiteSettings& wanted, btDiscreteDynamicsWorld& world,
                     HapticDevice& device, BulletAbi abi, HostStepListener& listener)
    : settings(checked(wanted)),
      host_world(world, listener, abi),
      island(makeIslandSettings(settings)),
      timeline(island, 1.0 / settings.haptic_rate, settings.host_step),
      clock(settings.host_step, settings.host_stall),
      hand(device, settings, island, handsOff()),
      forces(island, timeline, clock, bodies, hand.energy()),
      peers(settings, island, bodies, hand.energy(), log),
      grips(settings, island, bodies, hand, peers, log, handsOff() && !settings.guide),
      sender(settings, island, timeline, bodies, hand, peers, grips, log),
      surroundings(world, settings, island, timeline, clock, bodies, peers, hand, forces, log),
      press(world, island, timeline, bodies, surroundings),
      objects(world, island, timeline, bodies, peers, hand, forces, surroundings, log),
      rest(world, settings.hip_radius, log) {}

void SiteParts::runTicksUntil(double time) noexcept {
  for (;;) {
    const double next = timeline.nextTick(clock.time());
    if (next >= time - kClockTolerance) return;
    tick(next, kMostMadeUp);
  }
}

void SiteParts::noteTeleports() noexcept {
  for (SharedObject& object : bodies.objects) {
    if (!object.body.is_held) continue;
    const RigidState now = object.body.bullet->state(), last = island.state(object.body.index);
    if (!isTeleport(last, now, object.bounding_radius)) continue;
    island.setState(object.body.index, now);
    peers.beginEpoch(object);
  }
}

void SiteParts::followHostClock(double dt) noexcept {
  if (desk.isOpen()) {
    const double kept = static_cast<double>(timeline.room() - 2) * dt;
    clock.followLive(timeline.time(), dt, kept, timeline.period());
  } else {
    clock.follow(timeline.time(), dt);
  }
  if (!ticksInHostStep()) clock.watchLateness(timeline.time(), dt, timeline.period());
  log.counters.host_clock_set = clock.timesSet();
}

void SiteParts::passStepWithout(double dt) noexcept {
  followHostClock(dt);
  if (ticksInHostStep()) runTicksUntil(clock.time() + dt);
}

bool SiteParts::areBodiesPresent() noexcept {
  bool present = true;
  bodies.forEachPresent([&](SiteBody& body) { present &= body.bullet->isInWorld(); });
  if (!present) log.stop(kBodyMissing);
  return present;
}

}  // namespace tandem
