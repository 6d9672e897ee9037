#include "analyse/jobs.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace tandem::demos {
namespace {

/// What workers and their caller share.
class Work {
 public:
  explicit Work(const Jobs& jobs) : jobs_(jobs) {}

  /// Takes jobs until none is left, or until one failed.
  void help() {
    try {
      for (std::size_t i = next_++; i < jobs_.size() && !has_failed_; i = next_++) {
        jobs_[i]();
        ++done_;
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      has_failed_ = true;
    }
    const std::lock_guard lock(mutex_);
    ++ended_;
    end_.notify_one();
  }

  void await(std::size_t workers, const std::function<void(double)>& show) {
    std::unique_lock lock(mutex_);
    while (
        !end_.wait_for(lock, std::chrono::milliseconds(100), [&] { return ended_ == workers; })) {
      lock.unlock();
      show(static_cast<double>(done_) / static_cast<double>(jobs_.size()));
      lock.lock();
    }
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  const Jobs& jobs_;
  std::atomic<std::size_t> next_ = 0, done_ = 0;
  std::atomic<bool> has_failed_ = false;
  std::mutex mutex_;  // of the members below
  std::condition_variable end_;
  std::size_t ended_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

void runOnAllCores(const Jobs& jobs, const std::function<void(double)>& show) {
  Work work(jobs);
  const std::size_t count =
      std::min<std::size_t>(std::max(1U, std::thread::hardware_concurrency()), jobs.size());
  {
    std::vector<std::jthread> workers;
    for (std::size_t i = 0; i < count; ++i) workers.emplace_back([&work] { work.help(); });
    work.await(count, show);
  }
  work.rethrow();
}

}  // namespace tandem::demos
