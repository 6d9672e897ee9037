#include <algorithm>

#include "site/site_impl.h"

// What need not be done while nothing moves.
//
//   a body stands      -> parked: it sleeps in Bullet, no hand-off. Each host step asks whether the
//                         host or an impact has changed it, and whether the island moves it on.
//   the island sleeps  -> a tick reads the device, takes in packets and sends its own; the force,
//                         the states of its start and those for the host's steps are as they were.
//   both, for all      -> quiet: a host step asks its bodies and what they stand on, and does
//                         nothing else. Bullet wakes sleepers that something awake comes near to:
//                         then neighbours are looked for.

namespace tandem {
namespace {

/// A body that has stood for so many host steps may sleep.
constexpr int kStepsToPark = 4;

/// While nobody ticks.
constexpr std::uint64_t kStepsBetweenLooks = 64;

/// What stands farther away than this is not what bodies at rest stand on [m].
constexpr double kWatchMargin = 0.04;

}  // namespace

bool Site::Impl::mayPark(const SiteBody& body) const noexcept {
  const auto is_zero = [](const Vec3& v) { return v == Vec3::Zero(); };
  return is_zero(body.f_host_W) && is_zero(body.t_host_W) && is_zero(body.owed_W) &&
         is_zero(body.owed_angular_W);
}

void Site::Impl::parkIfItStood(SiteBody& body) noexcept {
  if (body.was_parked) return;
  const bool was_hit = body.hit_W != Vec3::Zero() || body.angular_hit_W != Vec3::Zero();
  body.steps_stood = body.stands && !was_hit ? body.steps_stood + 1 : 0;
  if (body.steps_stood < kStepsToPark || !body.may_park) return;
  body.bullet->park();
  if (body.bullet->isParked()) ++counters.bodies_parked;
}

void Site::Impl::unpark(SiteBody& body) noexcept {
  body.bullet->unpark();
  noteWoken(body);
}

void Site::Impl::noteWoken(SiteBody& body) noexcept {
  body.steps_stood = 0;
  ++counters.bodies_woken;
}

/// With nothing registered and nobody who ticks yet.
bool Site::Impl::isWaiting() const noexcept {
  // With a haptic thread the count of ticks is not to be read here.
  return !desk.isOpen() && ticks == 0 && isBare() && !native &&
         settings.tick_source == TickSource::kCaller;
}

/// What stands may be moved before the first tick: it is looked at now and then.
void Site::Impl::waitOn(double dt) {
  host_time += dt;
  host_step = dt;
  announceNextEnd(dt);
  if (counters.host_steps % kStepsBetweenLooks == 0) updateSurroundings(dt);
}

/// Pre-tick of a host step in which nothing is to be done; false if something is.
bool Site::Impl::skipBeforeHostStep(double dt) noexcept {
  quiet = may_skip && dt == host_step &&
          (quiet_bodies.empty() || standing_watch.isGravityUnchanged()) &&
          std::all_of(quiet_bodies.begin(), quiet_bodies.end(), [](const HapticBody* body) {
            return body->isInWorld() && body->isUndisturbed();
          });
  if (!quiet) return false;
  bool slept = false;
  desk.run([&] {
    slept = quiet = quiet_rest.holds(island);
    if (!slept) return;
    followHostClock(dt);
    host_force_settled = island_time;
    if (settings.tick_source != TickSource::kHostStep) return;
    const double end = host_time + dt;
    runTicksUntil(end);
    quiet = quiet_rest.holds(island);
    if (!quiet) findEnds(end);
  });
  if (slept && !quiet) handOff(dt);
  return slept;
}

/// Post-tick of such a step; false if something has happened all the same.
bool Site::Impl::skipAfterHostStep(double dt) noexcept {
  if (!quiet) return false;
  may_skip = std::all_of(quiet_bodies.begin(), quiet_bodies.end(),
                         [](const HapticBody* body) { return body->isAsleep(); }) &&
             standing_watch.isUnchanged();
  if (!may_skip) return false;
  desk.run([&] {
    host_time += dt;
    announceNextEnd(host_step);
  });
  ++counters.host_steps_skipped;
  return true;
}

/// After a host step with everything done: the next may be skipped if all sleep.
void Site::Impl::fallQuiet() {
  may_skip = false;
  if (!isHandoff()) return;
  bool all_parked = true;
  forEachBody([&](const SiteBody& body) { all_parked &= body.bullet->isParked(); });
  // What the host moves by hand may come at any step, and wakes nobody.
  if (!all_parked || (!isBare() && neighbour_search.isAnythingDriven())) return;

  Vec3 hand_W = Vec3::Zero();
  desk.run([&] {
    quiet_rest.clear();
    if (!island.isAsleep() || ticks == 0) return;
    quiet_rest.set(island);
    hand_W = island.state(hip).p_W;
    may_skip = true;
  });
  if (!may_skip) return;
  quiet_bodies.clear();
  forEachBody([&](const SiteBody& body) { quiet_bodies.push_back(body.bullet); });
  standing_watch.remember(quiet_bodies, hand_W, settings.hip_radius + kWatchMargin);
}

}  // namespace tandem
