#pragma once

#include <vector>

#include "bullet_bridge/src/bodies/sleep_watch.h"
#include "bullet_bridge/src/surroundings/standing_watch.h"
#include "site/bodies.h"
#include "site/rest_mark.h"
#include "site/site_log.h"

namespace tandem {

// clang-format off
/// Skips work while nothing moves.
///
///   a body stands      parked: it sleeps in Bullet without hand-off. Each host step asks whether
///                      the host or an impact changed it, and whether the island moves it.
///   the island sleeps  a tick reads the device and exchanges packets. Forces and states stay.
///   all of both        quiet: a host step only asks the bodies and their supports. Bullet wakes
///                      sleepers that an awake body approaches, and neighbours are searched again.
///
/// For the thread that steps the world, except begin(), stays() and mark().
// clang-format on
class Rest {
 public:
  Rest(btDiscreteDynamicsWorld& world, double hip_radius, SiteLog& log)
      : hip_radius_(hip_radius), log_(log), watch_(world), looks_(world) {}

  /// Something was added or removed: the next host step is not quiet.
  void disturb() noexcept { may_be_quiet_ = is_quiet_ = false; }

  /// Post-tick: parks a body that has stood still for some steps.
  void parkIfItStood(SiteBody& body) noexcept;
  void unpark(SiteBody& body) noexcept;
  void noteWoken(SiteBody& body) noexcept;

  /// Pre-tick: true if the host's world shows no change in this step.
  [[nodiscard]] bool looksQuiet() const noexcept;
  /// In the thread that ticks: true if the step is quiet for the island too. `looks_quiet` is the
  /// result of looksQuiet().
  bool begin(bool looks_quiet, const Island& island) noexcept {
    return is_quiet_ = looks_quiet && mark_.holds(island);
  }
  /// In the thread that ticks, after ticks of the step: true if the step is still quiet.
  bool stays(const Island& island) noexcept { return is_quiet_ = mark_.holds(island); }
  [[nodiscard]] bool isQuiet() const noexcept { return is_quiet_; }
  /// Post-tick of a quiet step: false if something changed in it.
  [[nodiscard]] bool staysQuiet() noexcept;

  /// In the thread that ticks, at the end of a step: remembers whether the island sleeps.
  void mark(const Island& island, const Vec3& hand_W) noexcept;
  /// Post-tick, with all bodies parked: the next step may be quiet if the island slept at mark().
  void fallQuiet(const Bodies& bodies);

 private:
  double hip_radius_;
  SiteLog& log_;
  StandingWatch watch_;
  SleepWatch looks_;                   ///< all bodies, while quiet
  RestMark mark_;                      ///< set by mark()
  bool is_marked_ = false;             ///< the island slept at mark()
  Vec3 hand_W_ = Vec3::Zero();         ///< position of the hand at mark() [m]
  bool may_be_quiet_ = false;          ///< the next step is quiet if nothing changes
  bool is_quiet_ = false;              ///< the present step is quiet
  std::vector<HapticBody*> sleepers_;  ///< work space
};

}  // namespace tandem
