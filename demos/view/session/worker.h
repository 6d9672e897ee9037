#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace tandem::view {

/// A thread that does work for another, which waits for it. Threads inherit the priority of the
/// thread that makes them: let a worker that was made before the window stepped back make sessions,
/// or their haptic threads would be as low as the window.
class Worker {
 public:
  Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Returns once `work` is done. Throws what it throws. One caller at a time.
  void run(const std::function<void()>& work);

 private:
  void serve(const std::stop_token& stop);

  std::mutex mutex_;  // of the two below
  const std::function<void()>* work_ = nullptr;
  std::exception_ptr problem_;
  std::condition_variable_any changed_;
  std::jthread thread_;  // the last: it ends before what it uses
};

}  // namespace tandem::view
