#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tandem/coordination/types.h"
#include "tandem/falcon/hid_port.h"

namespace tandem::test {

using Bytes = std::vector<std::uint8_t>;

inline HidReport makeReport(const Bytes& bytes) {
  HidReport report;
  report.size = std::min(bytes.size(), report.bytes.size());
  std::copy_n(bytes.begin(), report.size, report.bytes.begin());
  return report;
}

inline Bytes bytesOf(const HidReport& report) {
  return {report.bytes.begin(), report.bytes.begin() + static_cast<std::ptrdiff_t>(report.size)};
}

/// A HID device in memory that tests send to and read from. Ports opened on it may come and go. The
/// device must outlive them. Thread safe.
class FakeHidDevice {
 public:
  void send(const Bytes& report) {
    const std::lock_guard held(mutex_);
    inputs_.push_back(report);
    changed_.notify_all();
  }
  void setPluggedIn(bool is_plugged_in) {
    const std::lock_guard held(mutex_);
    is_plugged_in_ = is_plugged_in;
    if (!is_plugged_in) inputs_.clear();
    changed_.notify_all();
  }
  /// Refuses the next `count` output reports although the device is there.
  void refuseWrites(int count) {
    const std::lock_guard held(mutex_);
    refused_writes_ = count;
  }
  [[nodiscard]] std::vector<Bytes> outputs() const {
    const std::lock_guard held(mutex_);
    return outputs_;
  }
  [[nodiscard]] std::vector<Bytes> features() const {
    const std::lock_guard held(mutex_);
    return features_;
  }
  /// Called for each output report, by the thread that writes it, without the lock.
  std::function<void(const Bytes&)> on_output;

  [[nodiscard]] HidOpener opener() {
    return [this]() -> std::unique_ptr<HidPort> {
      const std::lock_guard held(mutex_);
      if (!is_plugged_in_) throw Error("the fake is not plugged in");
      return std::make_unique<Port>(*this);
    };
  }

 private:
  class Port final : public HidPort {
   public:
    explicit Port(FakeHidDevice& device) : device_(device) {}
    [[nodiscard]] const std::string& name() const noexcept override { return name_; }

    [[nodiscard]] std::ptrdiff_t read(std::uint8_t* report, std::size_t room,
                                      double wait) noexcept override {
      std::unique_lock held(device_.mutex_);
      device_.changed_.wait_for(held, std::chrono::duration<double>(wait), [this] {
        return !device_.inputs_.empty() || !device_.is_plugged_in_;
      });
      if (!device_.is_plugged_in_) return -1;
      if (device_.inputs_.empty()) return 0;
      const Bytes bytes = device_.inputs_.front();
      device_.inputs_.pop_front();
      const std::size_t size = std::min(room, bytes.size());
      std::copy_n(bytes.begin(), size, report);
      return static_cast<std::ptrdiff_t>(size);
    }

    [[nodiscard]] bool write(const std::uint8_t* report, std::size_t size) noexcept override {
      const Bytes bytes(report, report + size);
      {
        const std::lock_guard held(device_.mutex_);
        if (!device_.is_plugged_in_ || device_.refused_writes_-- > 0) return false;
        device_.refused_writes_ = 0;
        device_.outputs_.push_back(bytes);
      }
      if (device_.on_output) device_.on_output(bytes);
      return true;
    }

    [[nodiscard]] bool setFeature(const std::uint8_t* report, std::size_t size) noexcept override {
      const std::lock_guard held(device_.mutex_);
      if (!device_.is_plugged_in_) return false;
      device_.features_.emplace_back(report, report + size);
      return true;
    }

    [[nodiscard]] std::ptrdiff_t getFeature(std::uint8_t*, std::size_t) noexcept override {
      return -1;
    }

   private:
    FakeHidDevice& device_;
    std::string name_ = "HID fake";
  };

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Bytes> inputs_;
  std::vector<Bytes> outputs_, features_;
  int refused_writes_ = 0;
  bool is_plugged_in_ = true;
};

/// Waits for an outcome, ten seconds at most. Returns false on timeout.
inline bool comesTrue(const std::function<bool()>& outcome) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!outcome()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace tandem::test
