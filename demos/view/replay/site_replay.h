#pragma once

#include <vector>

#include "tandem/falcon/simulated_device.h"

#include "replay/recorded_run.h"
#include "run/site_links.h"
#include "session/scene_look.h"

namespace tandem::view {

/// One site of a recorded run: its world with all bodies where they were. Nothing is simulated.
class SiteReplay {
 public:
  /// `run` must have the site, counted from 0, and outlive this. Throws UsageError if the scenario
  /// makes other bodies than were recorded.
  SiteReplay(const RecordedRun& run, int site);

  /// Puts all bodies where they were at that time [s].
  void moveTo(double time);
  [[nodiscard]] demos::SiteWorld& world() noexcept { return world_; }
  [[nodiscard]] Vec3 hip_W() const noexcept { return hip_W_; }
  [[nodiscard]] Vec3 force_W() const noexcept { return force_W_; }

 private:
  void findBodies(const RecordedRun& run, int site);
  void placeBody(std::size_t body, double time);

  const RecordedSite& recorded_;
  demos::SceneFrame frame_;
  // Never used, but a site has them.
  demos::SiteLinks links_;
  SimulatedDevice device_{{}, makeConstantHand(Vec3::Zero())};
  demos::SiteWorld world_;
  std::vector<btCollisionObject*> bodies_;  ///< null: the hand, which has no body
  std::size_t hand_ = 0;                    ///< the body of the recorded scene that it is
  Vec3 hand_start_S_ = Vec3::Zero();        ///< at the first tick [m]
  Vec3 hip_W_ = Vec3::Zero(), force_W_ = Vec3::Zero();
};

}  // namespace tandem::view
