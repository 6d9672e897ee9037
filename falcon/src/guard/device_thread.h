#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace tandem {

/// A thread that uses a device and opens it again by itself after it was unplugged. It also keeps
/// the device's name and trouble for other threads.
class DeviceThread {
 public:
  /// The thread calls these in turn until it ends.
  struct Steps {
    std::function<void()> use;    ///< returns once the device is gone or isEnding(); never throws
    std::function<void()> close;  ///< never throws
    std::function<void()> open;   ///< throws if the device cannot be opened
  };

  /// `kind` names the device in messages. Attempts to open it again wait `first_retry` [s], then
  /// twice as long each time, at most `longest_retry` [s].
  DeviceThread(std::string kind, double first_retry, double longest_retry);
  /// Ends and joins the thread.
  ~DeviceThread();
  DeviceThread(const DeviceThread&) = delete;
  DeviceThread& operator=(const DeviceThread&) = delete;

  /// Starts with an open device. Each opening is followed by one closing, also if the thread ends
  /// in between. Throws what std::thread throws.
  void start(Steps steps);

  // For any thread.
  void end() noexcept;
  [[nodiscard]] bool isEnding() const noexcept { return is_ending_; }
  [[nodiscard]] std::uint64_t losses() const noexcept { return losses_; }

  // For any thread; the texts take a lock.
  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::string trouble() const;  ///< why the device could not be opened; or ""
  /// The device is open: there is no trouble.
  void setName(const std::string& name);
  void setTrouble(const std::string& trouble);

 private:
  void run(const Steps& steps) noexcept;
  [[nodiscard]] bool openAgain(const Steps& steps) noexcept;
  [[nodiscard]] bool tryOpen(const Steps& steps) noexcept;
  /// Sleeps for `time` [s]. Returns false if the thread ends meanwhile.
  [[nodiscard]] bool sleep(double time) noexcept;

  std::string kind_;
  double first_retry_, longest_retry_;
  std::atomic<bool> is_ending_{false};
  std::atomic<std::uint64_t> losses_{0};

  mutable std::mutex mutex_;  ///< guards the texts, and is_ending_ for the condition variable
  std::condition_variable ends_;
  std::string name_, trouble_;
  std::thread thread_;
};

}  // namespace tandem
