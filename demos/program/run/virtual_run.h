#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "tandem/plugin/recording.h"

#include "run/coherency.h"
#include "run/common_motion.h"
#include "run/scene_record.h"
#include "run/site_links.h"
#include "scenario/scenario.h"
#include "world/scene.h"
#include "world/site_summary.h"

namespace tandem::demos {

/// Results of a run: the numbers of summary.json.
struct RunSummary {
  double coherency_mean = 0.0,
         coherency_max = 0.0;  ///< the largest distance of copies at two sites [m]
  std::vector<PairCoherency> pairs;
  CommonMotion common_motion;
  std::vector<SiteSummary> sites;
  std::vector<FeltShares> felt;  ///< by each site's user
  std::uint64_t state_hash = 0;
  double real_time_factor = 0.0;
};

/// All sites of a scenario, a Bullet world for each and the network between, in virtual time: one
/// thread, as fast as the machine.
class VirtualRun {
 public:
  explicit VirtualRun(const Scenario& scenario);

  /// Runs to the end, and calls `progress` now and then with the finished share. Throws
  /// tandem::Error if a site reports a fault (a body removed, a state that is not finite).
  void run(const std::function<void(double)>& progress = {});

  [[nodiscard]] const RunSummary& summary() const noexcept { return summary_; }
  [[nodiscard]] int siteCount() const noexcept { return static_cast<int>(worlds_.size()); }
  [[nodiscard]] const Recording& recording(int site) const noexcept {
    return *recordings_[static_cast<std::size_t>(site)];
  }
  [[nodiscard]] const SceneFrame& frame() const noexcept { return frame_; }
  [[nodiscard]] SiteWorld& world(int site) noexcept {
    return *worlds_[static_cast<std::size_t>(site)];
  }
  [[nodiscard]] const SceneRecord& scene() const noexcept { return scene_; }

 private:
  void addSite(int site);
  void tickAll(std::uint64_t tick);
  void checkHealth();
  void summarise();
  void summariseSite(int site);

  Scenario scenario_;
  SceneFrame frame_;
  std::uint64_t tick_count_;
  SiteLinks links_;
  std::vector<std::unique_ptr<SiteWorld>> worlds_;
  std::vector<std::unique_ptr<Recording>> recordings_;
  std::optional<Coherency> coherency_;
  SceneRecord scene_;
  RunSummary summary_;
};

}  // namespace tandem::demos
