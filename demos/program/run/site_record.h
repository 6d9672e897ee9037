#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tandem/plugin/haptic_loop.h"
#include "tandem/plugin/recording.h"

#include "files/output_folder.h"
#include "run/scene_record.h"
#include "scenario/scenario.h"

namespace tandem::demos {

/// A session that ends when its user wants is recorded for this long [s]: 80 MB for each site.
inline constexpr double kLongestRecord = 120.0;

/// A live site leaves this behind: its ticks, and pictures of its world.
class SiteRecord {
 public:
  /// Records `world`, of a site from 0, for the first `duration` seconds of its ticks; what comes
  /// later is left out. Reserves all memory for ticks. `world` must not tick any more when this is
  /// deleted, and must outlive the last call.
  SiteRecord(const Scenario& scenario, int site, SiteWorld& world, double duration);
  SiteRecord(const SiteRecord&) = delete;
  SiteRecord& operator=(const SiteRecord&) = delete;

  /// After each host step, which ends at `time` [s], in its thread: keeps a picture if one is due.
  void noteStep(double time);

  // When no thread ticks or steps any more:

  /// True if there was a tick and a picture.
  [[nodiscard]] bool hasAnything() const noexcept;
  /// The keys of summary.json that one site can know, and its loop.
  [[nodiscard]] nlohmann::json summarise(const Scenario& scenario, const LoopReport& loop) const;
  /// Writes siteN.csv, sceneN.csv and siteN.json. Throws Error with the file's name.
  void write(const OutputFolder& folder, const nlohmann::json& summary) const;

 private:
  [[nodiscard]] nlohmann::json summariseSite(const Scenario& scenario) const;
  [[nodiscard]] double computeReceivedMean() const;

  int site_;
  SiteWorld& world_;
  SceneFrame frame_;
  Recording recording_;
  SceneRecord scene_;
  Vec3 object_start_W_ = Vec3::Zero();
};

/// Publishes what live sites wrote: all of it or, on an error, nothing. `site`, from 1, is the one
/// whose summary comes last.
void publishSites(const OutputFolder& folder, int site);

}  // namespace tandem::demos
