#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/methods/method.h"
#include "bench/scenes/bench_scene.h"

namespace tandem::demos::bench {

/// Largest differences to the reference over a run.
struct RunErrors {
  double tool = 0.0;   ///< position of any tool [m]
  double body = 0.0;   ///< centre of any body that moves [m]
  double force = 0.0;  ///< force of any tool's coupler, which its user feels [N]; 0 without coupler

  void include(const RunErrors& other);
  [[nodiscard]] double position() const { return tool > body ? tool : body; }
};

/// One method on one scene at one host rate.
struct AccuracyRun {
  std::string method;
  bool is_bullet_alone = false;  ///< Method::isBulletAlone()
  int host_rate = 0;             ///< [Hz]
  std::string reason;            ///< why it could not run; empty if it did
  bool diverged = false;         ///< left all bounds; then there are no errors and no time
  RunErrors errors;
  double us_per_second = 0.0;  ///< run time per simulated second [us], median of the repeats

  [[nodiscard]] bool isGood() const { return reason.empty() && !diverged; }
};

struct SceneAccuracy {
  std::string scene;
  std::string title;
  std::string reference;       ///< name of the solver, and its step
  RunErrors reference_errors;  ///< between the reference at its step and at half of it
  std::vector<AccuracyRun> runs;
};

struct AccuracyOptions {
  bool quick = false;               ///< coarser references, fewer host rates and repeats
  std::vector<std::string> scenes;  ///< names; empty: all
};

/// Called with the current activity and the finished share of the work.
using AccuracyProgress = std::function<void(std::string_view what, double share)>;

/// Runs every method on the scenes. Throws std::invalid_argument for an unknown scene.
[[nodiscard]] std::vector<SceneAccuracy> measureAccuracy(const AccuracyOptions& options,
                                                         const AccuracyProgress& progress);

}  // namespace tandem::demos::bench
