#include "session/worker.h"

#include <utility>

namespace tandem::view {

Worker::Worker() : thread_([this](const std::stop_token& stop) { serve(stop); }) {}

void Worker::run(const std::function<void()>& work) {
  std::unique_lock lock(mutex_);
  work_ = &work;
  changed_.notify_all();
  changed_.wait(lock, [&] { return work_ == nullptr; });
  if (problem_) std::rethrow_exception(std::exchange(problem_, nullptr));
}

void Worker::serve(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [&] { return work_ != nullptr; })) {
    try {
      (*work_)();
    } catch (...) {
      problem_ = std::current_exception();
    }
    work_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace tandem::view
