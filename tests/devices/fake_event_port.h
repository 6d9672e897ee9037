#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <linux/input.h>

#include "tandem/coordination/types.h"
#include "tandem/falcon/event_port.h"

namespace tandem::test {

/// An input device in memory: it has axes and keys, sends events, and keeps effects as the kernel
/// does. Ports opened on it may come and go. The device must outlive them. Thread safe.
class FakeEventDevice {
 public:
  /// A pad as the kernel's xpad driver shows it.
  static void makePad(FakeEventDevice& device) {
    for (const auto code : {ABS_X, ABS_Y, ABS_RX, ABS_RY}) device.setAxis(code, {0, -32768, 32767});
    for (const auto code : {ABS_Z, ABS_RZ}) device.setAxis(code, {0, 0, 255});
    device.setAxis(ABS_HAT0Y, {0, -1, 1});
    device.setFeel(Feel::kRumble);
  }
  /// A joystick with force feedback: two axes of force, a lever and a hat.
  static void makeStick(FakeEventDevice& device) {
    for (const auto code : {ABS_X, ABS_Y}) device.setAxis(code, {0, -128, 128});
    device.setAxis(ABS_THROTTLE, {0, 0, 255});
    device.setAxis(ABS_HAT0Y, {0, -1, 1});
    device.setFeel(Feel::kForce);
  }

  void setAxis(int code, const EventAxis& axis) {
    const std::lock_guard held(mutex_);
    axes_[code] = axis;
  }
  void setFeel(Feel feel) {
    const std::lock_guard held(mutex_);
    feel_ = feel;
  }
  /// Changes a place or a button without an event, as when the kernel drops it.
  void move(int code, std::int32_t value) {
    const std::lock_guard held(mutex_);
    axes_[code].value = value;
  }
  void press(int code, bool is_pressed) {
    const std::lock_guard held(mutex_);
    is_pressed ? (void)keys_.insert(code) : (void)keys_.erase(code);
  }
  void send(const std::vector<InputEvent>& events) {
    const std::lock_guard held(mutex_);
    events_.insert(events_.end(), events.begin(), events.end());
    changed_.notify_all();
  }
  /// Moves an axis or presses a key, and tells it.
  void tell(int type, int code, std::int32_t value) {
    if (type == EV_ABS) move(code, value);
    if (type == EV_KEY) press(code, value != 0);
    send({{static_cast<std::uint16_t>(type), static_cast<std::uint16_t>(code), value},
          {EV_SYN, SYN_REPORT, 0}});
  }
  void setPluggedIn(bool is_plugged_in) {
    const std::lock_guard held(mutex_);
    is_plugged_in_ = is_plugged_in;
    if (!is_plugged_in) {
      events_.clear();
      effects_.clear();
      playing_.clear();
    }
    changed_.notify_all();
  }
  void refuseUploads(bool refuses) {
    const std::lock_guard held(mutex_);
    refuses_ = refuses;
  }

  [[nodiscard]] std::map<int, FeelEffect> effects() const {
    const std::lock_guard held(mutex_);
    return effects_;
  }
  /// The effect that plays; level 0 if none does.
  [[nodiscard]] FeelEffect played() const {
    const std::lock_guard held(mutex_);
    return playing_.empty() ? FeelEffect() : effects_.at(*playing_.begin());
  }
  [[nodiscard]] int starts() const {
    const std::lock_guard held(mutex_);
    return starts_;
  }
  /// Uploads of new effects, and updates of them.
  [[nodiscard]] int created() const {
    const std::lock_guard held(mutex_);
    return created_;
  }
  [[nodiscard]] int updated() const {
    const std::lock_guard held(mutex_);
    return updated_;
  }

  [[nodiscard]] std::unique_ptr<EventPort> open() {
    const std::lock_guard held(mutex_);
    if (!is_plugged_in_) throw Error("the fake is not plugged in");
    return std::make_unique<Port>(*this);
  }
  [[nodiscard]] EventOpener opener() {
    return [this] { return open(); };
  }

 private:
  class Port final : public EventPort {
   public:
    explicit Port(FakeEventDevice& device) : device_(device) {}
    [[nodiscard]] const std::string& name() const noexcept override { return name_; }
    [[nodiscard]] std::ptrdiff_t read(InputEvent* events, std::size_t room,
                                      double wait) noexcept override {
      return device_.read(events, room, wait);
    }
    [[nodiscard]] std::optional<EventAxis> readAxis(std::uint16_t code) noexcept override {
      const std::lock_guard held(device_.mutex_);
      const auto found = device_.axes_.find(code);
      if (!device_.is_plugged_in_ || found == device_.axes_.end()) return std::nullopt;
      return found->second;
    }
    [[nodiscard]] bool readKey(std::uint16_t code) noexcept override {
      const std::lock_guard held(device_.mutex_);
      return device_.is_plugged_in_ && device_.keys_.count(code) > 0;
    }
    [[nodiscard]] Feel feel() const noexcept override {
      const std::lock_guard held(device_.mutex_);
      return device_.feel_;
    }
    [[nodiscard]] int upload(int id, const FeelEffect& effect) noexcept override {
      return device_.upload(id, effect);
    }
    bool play(int id, bool is_on) noexcept override { return device_.play(id, is_on); }
    void erase(int id) noexcept override {
      const std::lock_guard held(device_.mutex_);
      device_.effects_.erase(id);
      device_.playing_.erase(id);
    }

   private:
    FakeEventDevice& device_;
    std::string name_ = "fake pad";
  };

  std::ptrdiff_t read(InputEvent* events, std::size_t room, double wait) {
    std::unique_lock held(mutex_);
    changed_.wait_for(held, std::chrono::duration<double>(wait),
                      [this] { return !events_.empty() || !is_plugged_in_; });
    if (!is_plugged_in_) return -1;
    const std::size_t count = std::min(room, events_.size());
    std::copy_n(events_.begin(), count, events);
    events_.erase(events_.begin(), events_.begin() + static_cast<std::ptrdiff_t>(count));
    return static_cast<std::ptrdiff_t>(count);
  }

  int upload(int id, const FeelEffect& effect) {
    const std::lock_guard held(mutex_);
    if (!is_plugged_in_ || refuses_ || (id >= 0 && effects_.count(id) == 0)) return -1;
    ++(id < 0 ? created_ : updated_);
    const int number = id < 0 ? created_ + 2 : id;
    effects_[number] = effect;
    return number;
  }

  bool play(int id, bool is_on) {
    const std::lock_guard held(mutex_);
    if (!is_plugged_in_ || effects_.count(id) == 0) return false;
    starts_ += is_on ? 1 : 0;
    is_on ? (void)playing_.insert(id) : (void)playing_.erase(id);
    return true;
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<int, EventAxis> axes_;
  std::set<int> keys_, playing_;
  std::deque<InputEvent> events_;
  std::map<int, FeelEffect> effects_;
  Feel feel_ = Feel::kNothing;
  int starts_ = 0, created_ = 0, updated_ = 0;
  bool is_plugged_in_ = true, refuses_ = false;
};

}  // namespace tandem::test
