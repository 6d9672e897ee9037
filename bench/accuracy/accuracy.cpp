#include "bench/accuracy/accuracy.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <stdexcept>

#include <fmt/format.h>

#include "bench/accuracy/comparison.h"
#include "bench/accuracy/experiment2.h"
#include "bench/methods/all_methods.h"
#include "bench/reference/planar_reference.h"
#include "bench/reference/smooth_reference.h"

namespace tandem::demos::bench {
namespace {

bool isWanted(const AccuracyOptions& options, std::string_view scene) {
  return options.scenes.empty() ||
         std::find(options.scenes.begin(), options.scenes.end(), scene) != options.scenes.end();
}

/// Throws std::invalid_argument for an unknown scene name.
std::vector<const BenchScene*> chooseScenes(const AccuracyOptions& options) {
  std::vector<const BenchScene*> chosen;
  std::vector<std::string> names;
  for (const BenchScene& scene : allScenes()) {
    names.push_back(scene.name);
    if (isWanted(options, scene.name)) chosen.push_back(&scene);
  }
  names.emplace_back(kExperiment2);
  for (const std::string& name : options.scenes)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw std::invalid_argument(
          fmt::format("{}: there is no such scene; allowed: {}", name, fmt::join(names, ", ")));
  return chosen;
}

/// Steps per second of the finer planar reference.
constexpr int kPlanarRate = 384000, kQuickPlanarRate = 48000;

ReferenceRun runReference(const BenchScene& scene, bool quick, SceneAccuracy& result) {
  const int rate = quick ? kQuickPlanarRate : kPlanarRate;
  const auto run = [&](int part) {
    return scene.is_smooth ? runSmoothReference(scene, part * 0.5 / kGridRate)
                           : runPlanarReference(scene, rate / part);
  };
  // Both take long for piles.
  auto coarse = std::async(std::launch::async, run, 2);
  ReferenceRun fine = run(1);
  result.reference = scene.is_smooth ? "Runge-Kutta-Fehlberg 7(8), events located"
                                     : fmt::format("planar rigid solver at {} kHz", rate / 1000);
  result.reference_errors = compareReferences(scene, coarse.get(), fine);
  return fine;
}

using Clock = std::chrono::steady_clock;

/// Time since `start` [us].
double microsecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

/// Its run time contains the comparison, which counts in short runs only.
AccuracyRun runOnce(const BenchScene& scene, const Method& method, int host_rate,
                    const ReferenceRun& reference) {
  AccuracyRun run;
  run.method = method.name();
  run.is_bullet_alone = method.isBulletAlone();
  run.host_rate = host_rate;
  try {
    const auto simulation = method.start(scene, host_rate);
    const auto start = Clock::now();
    const auto errors = compareRun(scene, host_rate, *simulation, reference);
    run.us_per_second = microsecondsSince(start) / scene.duration;
    run.diverged = !errors;
    if (errors) run.errors = *errors;
  } catch (const std::exception& why) {
    run.reason = why.what();
  }
  return run;
}

/// Run time per simulated second [us].
double timeOnce(const BenchScene& scene, const Method& method, int host_rate) {
  const auto simulation = method.start(scene, host_rate);
  const auto steps = static_cast<int>(std::floor(scene.duration * host_rate + 1e-6));
  const auto start = Clock::now();
  for (int n = 0; n < steps; ++n) simulation->step();
  return microsecondsSince(start) * host_rate / steps;
}

/// A run longer than this is timed once, while it is compared [us].
constexpr double kLongRun = 3e5;

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A run that is being timed.
struct Timed {
  const Method* method;
  std::size_t run;
  std::vector<double> times;
};

class Accuracy {
 public:
  Accuracy(const AccuracyOptions& options, const AccuracyProgress& progress)
      : options_(options), progress_(progress), scenes_(chooseScenes(options)) {}

  std::vector<SceneAccuracy> measure() {
    std::vector<SceneAccuracy> results;
    for (const BenchScene* scene : scenes_) {
      results.push_back(measureScene(*scene));
      ++scenes_done_;
    }
    if (has_experiment2_) {
      tell(kExperiment2, "all", 0.0);
      results.push_back(measureExperiment2(hostRates(), options_.quick));
    }
    return results;
  }

 private:
  SceneAccuracy measureScene(const BenchScene& scene) {
    SceneAccuracy result;
    result.scene = scene.name;
    result.title = scene.title;
    tell(scene.name, "reference", 0.0);
    const ReferenceRun reference = runReference(scene, options_.quick, result);

    std::vector<Timed> timed;
    for (const auto& method : allMethods()) {
      tell(scene.name, method->name(), 0.4);
      for (const int host_rate : hostRates()) {
        result.runs.push_back(runOnce(scene, *method, host_rate, reference));
        const AccuracyRun& run = result.runs.back();
        if (run.isGood() && run.us_per_second * scene.duration < kLongRun)
          timed.push_back({method.get(), result.runs.size() - 1, {}});
      }
    }
    // The methods' times are compared, so the methods take turns.
    for (int repeat = 0; repeat < repeats(); ++repeat) {
      tell(scene.name, "run times", 0.6 + 0.4 * repeat / repeats());
      for (Timed& one : timed)
        one.times.push_back(timeOnce(scene, *one.method, result.runs[one.run].host_rate));
    }
    for (Timed& one : timed) result.runs[one.run].us_per_second = medianOf(std::move(one.times));
    return result;
  }

  void tell(std::string_view scene, std::string_view what, double share_of_scene) const {
    const std::size_t count = scenes_.size() + (has_experiment2_ ? 1 : 0);
    progress_(fmt::format("{}: {}", scene, what),
              (static_cast<double>(scenes_done_) + share_of_scene) / static_cast<double>(count));
  }

  [[nodiscard]] std::vector<int> hostRates() const {
    return options_.quick ? std::vector<int>{60, 240, 1000}
                          : std::vector<int>{60, 120, 240, 1000, 4000};
  }
  [[nodiscard]] int repeats() const { return options_.quick ? 3 : 5; }

  const AccuracyOptions& options_;
  const AccuracyProgress& progress_;
  std::vector<const BenchScene*> scenes_;
  bool has_experiment2_ = isWanted(options_, kExperiment2);
  std::size_t scenes_done_ = 0;
};

}  // namespace

std::vector<SceneAccuracy> measureAccuracy(const AccuracyOptions& options,
                                           const AccuracyProgress& progress) {
  return Accuracy(options, progress).measure();
}

}  // namespace tandem::demos::bench
