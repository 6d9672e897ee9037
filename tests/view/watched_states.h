#pragma once

#include "tandem/plugin/watcher.h"

namespace tandem::test {

/// States of a site as a spectator hears them: a hand and one object.
class WatchedStates {
 public:
  /// The next state, of the site's `time`, heard at `heard_at` [s].
  const WatchedSite& next(double time, double heard_at, const PointState& hand,
                          const Vec3& object_W = Vec3::Zero()) {
    ++site_.states;
    site_.heard_at = heard_at;
    site_.newest.time = time;
    site_.newest.user = hand;
    site_.newest.object_count = 1;
    site_.newest.objects[0].state.p_W = object_W;
    return site_;
  }

 private:
  WatchedSite site_;
};

}  // namespace tandem::test
