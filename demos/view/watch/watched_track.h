#pragma once

#include <map>

#include "tandem/plugin/watcher.h"

#include "watch/motion_history.h"

namespace tandem::view {

/// What a spectator has heard of one site, and how it moved. States come 32 times a second, so the
/// site is shown a bit later than it could be, and moves evenly whatever the network does.
class WatchedTrack {
 public:
  /// Two periods of states: one may be lost, or late by this [s].
  static constexpr double kLate = 2.0 / 32.0;
  /// A site without a state for longer is silent [s].
  static constexpr double kSilent = 0.5;

  /// Takes the newest state of the site. One that was taken before changes nothing.
  void take(const WatchedSite& site);

  /// Since the newest state [s].
  [[nodiscard]] double age(double now) const { return now - heard_at_; }
  [[nodiscard]] bool isLive(double now) const { return age(now) < kSilent; }

  // At `now` by the spectator's clock, once a state was taken. Velocities mean nothing.

  [[nodiscard]] Vec3 hand(double now) const;
  /// Empty if the site has not told this object.
  [[nodiscard]] std::optional<RigidState> object(ObjectId id, double now) const;

 private:
  /// Everything comes from where it was last seen.
  void begin(double time, double offset);
  /// The site's time that is shown [s].
  [[nodiscard]] double shownTime(double now) const { return now - offset_ - kLate; }

  std::uint64_t states_ = 0;  ///< WatchedSite::states of the newest
  double heard_at_ = 0.0;     ///< [s]
  double time_ = 0.0;         ///< of the site, in its newest state [s]
  double offset_ = 0.0;       ///< from its clock to the own one, with the shortest way [s]
  MotionHistory hand_;
  std::map<ObjectId, MotionHistory> objects_;
};

}  // namespace tandem::view
