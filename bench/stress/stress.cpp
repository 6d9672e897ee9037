#include "bench/stress/stress.h"

#include <algorithm>
#include <cerrno>
#include <chrono>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <LinearMath/btScalar.h>

#include "tandem/coordination/types.h"

namespace tandem::demos::bench {
namespace {

/// Largest energy of a closed loop over the energy input; beyond this it explodes.
constexpr double kMostGrowth = 10.0;

/// Limit of the deviation from the reference, over the largest displacement. A float host rounds
/// its values.
constexpr double kMostDeviation = sizeof(btScalar) == sizeof(double) ? 2e-5 : 2e-4;

/// Way beyond the speed limit that counts as rounding [m].
constexpr double kLeastJump = 1e-9;

/// A process that runs every n-th case and writes its outcomes to a pipe.
class Worker {
 public:
  Worker(const StressOptions& options, std::uint64_t first) : options_(options), next_(first) {
    start();
  }
  ~Worker() { stop(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  [[nodiscard]] int pipe() const { return pipe_; }
  [[nodiscard]] bool isDone() const { return next_ >= options_.cases; }

  /// Waits for the next outcome. A case that ended the process is a crash, and a new process
  /// continues after it.
  StressOutcome take() {
    StressOutcome outcome;
    if (!readWhole(outcome)) {
      outcome = {};
      outcome.index = next_;
      outcome.crashed = true;
      outcome.kind = static_cast<std::int32_t>(drawStressCase(options_.seed, next_).kind);
      stop();
      next_ += stride();
      if (!isDone()) start();
      return outcome;
    }
    next_ = outcome.index + stride();
    return outcome;
  }

 private:
  [[nodiscard]] std::uint64_t stride() const {
    return static_cast<std::uint64_t>(options_.workers);
  }

  void start() {
    int ends[2];
    if (::pipe(ends) != 0) throw Error("cannot make a pipe for a worker process");
    pipe_ = ends[0];
    process_ = fork();
    if (process_ < 0) throw Error("cannot start a worker process; close other programs");
    if (process_ > 0) {
      close(ends[1]);
      return;
    }
    for (std::uint64_t index = next_; index < options_.cases; index += stride()) {
      const StressOutcome outcome = runStressCase(drawStressCase(options_.seed, index));
      if (write(ends[1], &outcome, sizeof outcome) != static_cast<ssize_t>(sizeof outcome)) break;
    }
    _exit(0);
  }

  void stop() {
    if (process_ <= 0) return;
    close(pipe_);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }

  bool readWhole(StressOutcome& outcome) {
    auto* bytes = reinterpret_cast<char*>(&outcome);
    std::size_t done = 0;
    while (done < sizeof outcome) {
      const ssize_t count = read(pipe_, bytes + done, sizeof outcome - done);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      done += static_cast<std::size_t>(count);
    }
    return true;
  }

  const StressOptions& options_;
  std::uint64_t next_;
  pid_t process_ = 0;
  int pipe_ = -1;
};

std::vector<StressOutcome> runCases(const StressOptions& options, const StressProgress& progress) {
  std::vector<StressOutcome> outcomes(options.cases);
  std::vector<std::unique_ptr<Worker>> workers;
  for (int w = 0; w < options.workers; ++w)
    workers.push_back(std::make_unique<Worker>(options, static_cast<std::uint64_t>(w)));
  for (std::uint64_t done = 0; done < options.cases;) {
    std::vector<pollfd> pipes;
    std::vector<Worker*> busy;
    for (const auto& worker : workers) {
      if (worker->isDone()) continue;
      pipes.push_back({worker->pipe(), POLLIN, 0});
      busy.push_back(worker.get());
    }
    if (poll(pipes.data(), pipes.size(), -1) < 0 && errno != EINTR)
      throw Error("cannot wait for the worker processes");
    for (std::size_t i = 0; i < pipes.size(); ++i) {
      if (pipes[i].revents == 0) continue;
      const StressOutcome outcome = busy[i]->take();
      outcomes[outcome.index] = outcome;
      ++done;
    }
    progress("cases", static_cast<double>(done) / static_cast<double>(options.cases));
  }
  return outcomes;
}

}  // namespace

std::string_view nameOf(StressFailure failure) {
  constexpr std::string_view kNames[] = {"crash", "not_finite", "energy",
                                         "jump",  "explosion",  "reference"};
  return kNames[static_cast<int>(failure)];
}

std::vector<StressFailure> findFailures(const StressOutcome& outcome) {
  std::vector<StressFailure> failures;
  if (outcome.crashed) return {StressFailure::kCrash};
  if (!outcome.finite) failures.push_back(StressFailure::kNotFinite);
  if (!(outcome.unaccounted <= outcome.allowed)) failures.push_back(StressFailure::kEnergy);
  if (!(outcome.jump <= kLeastJump)) failures.push_back(StressFailure::kJump);
  if (outcome.is_stable && !(outcome.growth <= kMostGrowth))
    failures.push_back(StressFailure::kExplosion);
  if (!(outcome.deviation <= kMostDeviation)) failures.push_back(StressFailure::kReference);
  return failures;
}

std::size_t StressResult::countFailed() const {
  return static_cast<std::size_t>(
      std::count_if(outcomes.begin(), outcomes.end(),
                    [](const StressOutcome& outcome) { return !findFailures(outcome).empty(); }));
}

StressResult measureStress(const StressOptions& options, const StressProgress& progress) {
  StressResult result;
  result.options = options;
  const auto start = std::chrono::steady_clock::now();
  result.outcomes = runCases(
      result.options, [&](std::string_view what, double share) { progress(what, 0.9 * share); });
  result.maps = makeStabilityMaps(options.quick, [&](std::string_view what, double share) {
    progress(what, 0.9 + 0.1 * share);
  });
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  result.seconds = wall.count();
  return result;
}

}  // namespace tandem::demos::bench
