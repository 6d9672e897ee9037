#pragma once

#include <array>
#include <functional>
#include <memory>

#include "tandem/plugin/recording.h"

#include "run/scene_record.h"
#include "scenario/scenario.h"
#include "world/scene.h"
#include "world/site_summary.h"

namespace tandem::demos {

/// Results of a run: the numbers of summary.json.
struct RunSummary {
  double coherency_mean = 0.0,
         coherency_max = 0.0;  ///< the largest |copy at site 1 - at site 2| [m]
  SiteSummary sites[2];
  std::uint64_t state_hash = 0;
  double real_time_factor = 0.0;
};

/// Two sites, two Bullet worlds and the network between, in virtual time: one thread, as fast as
/// the machine.
class VirtualRun {
 public:
  explicit VirtualRun(const Scenario& scenario);

  /// Runs to the end, and calls `progress` now and then with the finished share. Throws
  /// tandem::Error if a site reports a fault (a body removed, a state that is not finite).
  void run(const std::function<void(double)>& progress = {});

  [[nodiscard]] const RunSummary& summary() const noexcept { return summary_; }
  [[nodiscard]] const Recording& recording(int site) const noexcept { return *recordings_[site]; }
  [[nodiscard]] const SceneFrame& frame() const noexcept { return frame_; }
  [[nodiscard]] SiteWorld& world(int site) noexcept { return *worlds_[site]; }
  [[nodiscard]] const SceneRecord& scene() const noexcept { return scene_; }

 private:
  void tickAll(std::uint64_t tick);
  void addCoherency();
  void checkHealth();
  void summarise();

  Scenario scenario_;
  SceneFrame frame_;
  std::uint64_t tick_count_;
  std::unique_ptr<SimulatedLink> ends_[2];
  std::unique_ptr<SiteWorld> worlds_[2];
  std::unique_ptr<Recording> recordings_[2];
  /// First object as each site last heard of it [m].
  std::array<Vec3, 2> received_W_ = {Vec3::Zero(), Vec3::Zero()};
  SceneRecord scene_;
  RunSummary summary_;
};

}  // namespace tandem::demos
