#pragma once

#include <cerrno>
#include <cstdint>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tandem/coordination/types.h"

namespace tandem::demos::bench {

/// A process that runs every n-th case and writes its outcomes to a pipe. `Outcome` is a plain
/// value with an `index`.
template <typename Outcome>
class CaseWorker {
  static_assert(std::is_trivially_copyable_v<Outcome>);

 public:
  using Run = std::function<Outcome(std::uint64_t)>;

  CaseWorker(std::uint64_t cases, std::uint64_t first, std::uint64_t stride, const Run& run,
             const Run& crash)
      : cases_(cases), next_(first), stride_(stride), run_(run), crash_(crash) {
    if (!isDone()) start();
  }
  ~CaseWorker() { stop(); }
  CaseWorker(const CaseWorker&) = delete;
  CaseWorker& operator=(const CaseWorker&) = delete;

  [[nodiscard]] int pipe() const { return pipe_; }
  [[nodiscard]] bool isDone() const { return next_ >= cases_; }

  /// Waits for the next outcome. A case that ended the process is a crash, and a new process
  /// continues after it.
  Outcome take() {
    Outcome outcome;
    if (readWhole(outcome)) {
      next_ = outcome.index + stride_;
      return outcome;
    }
    outcome = crash_(next_);
    outcome.index = next_;
    stop();
    next_ += stride_;
    if (!isDone()) start();
    return outcome;
  }

 private:
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
    for (std::uint64_t index = next_; index < cases_; index += stride_) {
      const Outcome outcome = run_(index);
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

  bool readWhole(Outcome& outcome) {
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

  std::uint64_t cases_, next_, stride_;
  const Run& run_;
  const Run& crash_;
  pid_t process_ = 0;
  int pipe_ = -1;
};

/// Runs `run` for the cases 0 to `cases` - 1 in worker processes, so that a crash is one failure
/// and not the end. `crash` makes the outcome of a case that ended its process. The result is
/// ordered by index. `progress` gets the finished share. Throws tandem::Error if no process can be
/// started.
template <typename Outcome>
[[nodiscard]] std::vector<Outcome> runInWorkers(std::uint64_t cases, int count,
                                                const typename CaseWorker<Outcome>::Run& run,
                                                const typename CaseWorker<Outcome>::Run& crash,
                                                const std::function<void(double)>& progress) {
  std::vector<Outcome> outcomes(cases);
  std::vector<std::unique_ptr<CaseWorker<Outcome>>> workers;
  for (int w = 0; w < count; ++w)
    workers.push_back(std::make_unique<CaseWorker<Outcome>>(
        cases, static_cast<std::uint64_t>(w), static_cast<std::uint64_t>(count), run, crash));
  for (std::uint64_t done = 0; done < cases;) {
    std::vector<pollfd> pipes;
    std::vector<CaseWorker<Outcome>*> busy;
    for (const auto& worker : workers) {
      if (worker->isDone()) continue;
      pipes.push_back({worker->pipe(), POLLIN, 0});
      busy.push_back(worker.get());
    }
    if (poll(pipes.data(), pipes.size(), -1) < 0 && errno != EINTR)
      throw Error("cannot wait for the worker processes");
    for (std::size_t i = 0; i < pipes.size(); ++i) {
      if (pipes[i].revents == 0) continue;
      const Outcome outcome = busy[i]->take();
      outcomes[outcome.index] = outcome;
      ++done;
    }
    progress(static_cast<double>(done) / static_cast<double>(cases));
  }
  return outcomes;
}

}  // namespace tandem::demos::bench
