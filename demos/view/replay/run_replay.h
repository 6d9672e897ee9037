#pragma once

#include <memory>
#include <optional>

#include "replay/recorded_run.h"
#include "replay/site_replay.h"
#include "session/session.h"

namespace tandem::view {

/// A recorded run as one of its users saw it. For one thread.
class RunReplay {
 public:
  /// `user` counts from 0; without it the first one whose site was recorded. Throws UsageError if
  /// that site was not.
  RunReplay(RecordedRun run, std::optional<int> user);
  RunReplay(const RunReplay&) = delete;
  RunReplay& operator=(const RunReplay&) = delete;

  /// What the user saw at that time [s]. The list has no hand of the user's own.
  [[nodiscard]] SessionLook look(double time);

  /// Places of the user's hand, the others' and the objects in all recorded pictures [m].
  [[nodiscard]] std::vector<Vec3> findWays();

  [[nodiscard]] int user() const noexcept { return user_; }
  [[nodiscard]] const demos::Scenario& scenario() const noexcept { return run_.scenario; }
  [[nodiscard]] double duration() const noexcept { return run_.duration; }
  /// Moments of the recorded pictures, growing [s].
  [[nodiscard]] const std::vector<double>& frames() const;

 private:
  [[nodiscard]] int chooseUser(std::optional<int> wanted) const;

  RecordedRun run_;
  int user_;
  SiteReplay own_;
  std::vector<std::unique_ptr<SiteReplay>> others_;  ///< all other sites that were recorded
  SceneLook scene_look_;
};

}  // namespace tandem::view
