#include "guard/device_thread.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

namespace tandem {

DeviceThread::DeviceThread(std::string kind, double first_retry, double longest_retry)
    : kind_(std::move(kind)), first_retry_(first_retry), longest_retry_(longest_retry) {}

DeviceThread::~DeviceThread() {
  end();
  if (thread_.joinable()) thread_.join();
}

void DeviceThread::start(Steps steps) {
  thread_ = std::thread([this, steps = std::move(steps)] { run(steps); });
}

void DeviceThread::end() noexcept {
  {
    const std::lock_guard held(mutex_);
    is_ending_ = true;
  }
  ends_.notify_all();
}

std::string DeviceThread::name() const {
  const std::lock_guard held(mutex_);
  return name_;
}

std::string DeviceThread::trouble() const {
  const std::lock_guard held(mutex_);
  return trouble_;
}

void DeviceThread::setName(const std::string& name) {
  const std::lock_guard held(mutex_);
  name_ = name;
  trouble_.clear();
}

void DeviceThread::setTrouble(const std::string& trouble) {
  const std::lock_guard held(mutex_);
  trouble_ = trouble;
}

void DeviceThread::run(const Steps& steps) noexcept {
  do {
    steps.use();
    if (!is_ending_) ++losses_;
    steps.close();
  } while (openAgain(steps));
}

bool DeviceThread::openAgain(const Steps& steps) noexcept {
  double wait = first_retry_;
  do {
    if (!sleep(wait)) return false;
    wait = std::min(2.0 * wait, longest_retry_);
  } while (!tryOpen(steps));
  return true;
}

bool DeviceThread::tryOpen(const Steps& steps) noexcept {
  std::string trouble = "the " + kind_ + "'s opener threw what is no std::exception";
  try {
    steps.open();
    return true;
  } catch (const std::exception& error) {
    trouble = error.what();
  } catch (...) {  // this thread survives whatever the caller's function throws
  }
  setTrouble(trouble);
  return false;
}

bool DeviceThread::sleep(double time) noexcept {
  std::unique_lock held(mutex_);
  ends_.wait_for(held, std::chrono::duration<double>(time), [this] { return is_ending_.load(); });
  return !is_ending_;
}

}  // namespace tandem
