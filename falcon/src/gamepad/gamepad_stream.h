#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "tandem/falcon/gamepad_device.h"

#include "gamepad/gamepad_line.h"
#include "guard/device_thread.h"
#include "guard/latest_value.h"

namespace tandem {

/// A thread that reads a gamepad's events and renders a force on it 100 times a second. It opens
/// the device again by itself after it was unplugged. Uploads may take milliseconds, so the haptic
/// thread must not wait for them. Its destructor stops the effect and joins the thread.
class GamepadStream {
 public:
  /// State on its way from the thread to the haptic thread.
  struct News {
    GamepadState state;
    Feel feel = Feel::kNothing;
    bool is_connected = false;
    double time = 0.0;  ///< the thread's last sign, on the monotonic clock [s]
  };

  /// Opens the device. Throws what `open` throws, and tandem::Error for a device without sticks.
  /// Throws std::invalid_argument for settings out of range.
  GamepadStream(EventOpener open, const GamepadSettings& settings);
  GamepadStream(const GamepadStream&) = delete;
  GamepadStream& operator=(const GamepadStream&) = delete;

  // For the haptic thread; wait-free.
  [[nodiscard]] const News& newest() noexcept { return news_.read(); }
  void setForce(const Vec3& f_D) noexcept;

  // For any thread; the texts take a lock.
  [[nodiscard]] GamepadCounters counters() const noexcept;
  [[nodiscard]] std::string name() const { return thread_.name(); }
  [[nodiscard]] std::string trouble() const { return thread_.trouble(); }

 private:
  /// A force on its way to the thread.
  struct Order {
    std::array<double, 3> f_D{};
    double time = -1.0;  ///< on the monotonic clock [s]
  };

  void connect();
  void disconnect() noexcept;
  void exchangeUntilGone() noexcept;
  [[nodiscard]] bool listen(double wait) noexcept;
  void render(double now) noexcept;
  void publish() noexcept;

  EventOpener open_;
  GamepadSettings settings_;
  std::unique_ptr<GamepadLine> line_;  ///< null: not plugged in

  LatestValue<News> news_;
  LatestValue<Order> order_;
  std::atomic<std::uint64_t> reports_{0}, dropped_{0}, uploads_{0}, refused_{0};
  DeviceThread thread_;  ///< last, because the thread uses the members above
};

}  // namespace tandem
