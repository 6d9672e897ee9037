#pragma once

#include <vector>

#include "bullet_bridge/src/surroundings/standing_watch.h"
#include "site/bodies.h"
#include "site/rest_mark.h"
#include "site/site_log.h"

namespace tandem {

/// What need not be done while nothing moves.
///
///   a body stands      parked: it sleeps in Bullet, no hand-off. Each host step asks whether the
///                      host or an impact has changed it, and whether the island moves it on.
///   the island sleeps  a tick reads the device, takes in packets and sends its own; the force, the
///                      states of its start and those for the host's steps are as they were.
///   both, for all      quiet: a host step asks its bodies and what they stand on, and does nothing
///                      else. Bullet wakes sleepers that something awake comes near to: then
///                      neighbours are looked for.
///
/// For the thread that steps the world, but for begin(), stays() and mark().
class Rest {
 public:
  Rest(btDiscreteDynamicsWorld& world, double hip_radius, SiteLog& log)
      : hip_radius_(hip_radius), log_(log), watch_(world) {}

  /// Something has come or gone: the next host step is not quiet.
  void disturb() noexcept { may_be_quiet_ = is_quiet_ = false; }

  /// Post-tick: a body that has stood for some steps sleeps in Bullet.
  void parkIfItStood(SiteBody& body) noexcept;
  void unpark(SiteBody& body) noexcept;
  void noteWoken(SiteBody& body) noexcept;

  /// Pre-tick: true if this step is quiet as far as the host's world tells.
  [[nodiscard]] bool looksQuiet() const noexcept;
  /// Asked: whether it is quiet for the island, too; `looks_quiet` as just said.
  bool begin(bool looks_quiet, const Island& island) noexcept {
    return is_quiet_ = looks_quiet && mark_.holds(island);
  }
  /// Asked: whether it is after ticks of the step have been run.
  bool stays(const Island& island) noexcept { return is_quiet_ = mark_.holds(island); }
  [[nodiscard]] bool isQuiet() const noexcept { return is_quiet_; }
  /// Post-tick of a quiet step: false if something has happened all the same.
  [[nodiscard]] bool staysQuiet() noexcept;

  /// Asked, when everything of a step has been done: remembers whether the island sleeps.
  void mark(const Island& island, const Vec3& hand_W) noexcept;
  /// Post-tick: the next step may be quiet if the island slept at the mark. All bodies are parked.
  void fallQuiet(const Bodies& bodies);

 private:
  double hip_radius_;
  SiteLog& log_;
  StandingWatch watch_;
  RestMark mark_;                      ///< the island sleeps since
  bool is_marked_ = false;             ///< and slept then
  Vec3 hand_W_ = Vec3::Zero();         ///< where the hand was then
  bool may_be_quiet_ = false;          ///< the next step, if nothing changes
  bool is_quiet_ = false;              ///< the present one
  std::vector<HapticBody*> sleepers_;  ///< all bodies, while quiet
};

}  // namespace tandem
