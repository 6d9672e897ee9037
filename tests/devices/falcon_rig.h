#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "falcon/src/novint/falcon_driver.h"
#include "falcon/src/novint/falcon_emulator.h"

namespace tandem::test {

/// A hand that pulls the grip out and pushes it in again, so that all legs pass their index marks.
inline std::unique_ptr<Hand> makeHomingHand(double start) {
  return makeMinimumJerkHand({{start, Vec3::Zero()},
                              {start + 0.6, Vec3(0.0, 0.0, 0.045)},
                              {start + 1.2, Vec3(0.0, 0.0, -0.02)},
                              {start + 1.4, Vec3::Zero()}},
                             800.0, 8.0);
}

inline FalconEmulatorSettings readyDevice() {
  FalconEmulatorSettings settings;
  settings.runs = settings.is_homed = true;
  return settings;
}

/// The device with the worst effect of commands beyond the motors' range.
inline FalconEmulatorSettings makeHarsh(FalconEmulatorSettings settings) {
  settings.overrange = FalconOverrange::kIgnore;
  return settings;
}

/// Driver and emulator connected directly, in virtual time.
class FalconRig {
 public:
  static constexpr double kLook = 0.00025;  ///< [s]

  explicit FalconRig(const FalconEmulatorSettings& device, const FalconSettings& settings = {},
                     std::unique_ptr<Hand> hand = nullptr)
      : emulator(makeHarsh(device), std::move(hand)), driver(settings, makeSyntheticFirmware(7)) {}

  /// Runs for `duration`; calls `each` before the driver in every step.
  void run(double duration, const std::function<void(double)>& each = nullptr) {
    const long looks = std::lround(duration / kLook);
    for (long i = 0; i < looks; ++i) {
      if (each) each(now());
      look();
      ++looks_;
    }
  }

  /// Runs until the driver is in `state`. Returns false after `longest`.
  bool runUntil(FalconState state, double longest) {
    for (const double end = now() + longest; now() < end; run(0.001))
      if (driver.status().state == state) return true;
    return driver.status().state == state;
  }

  /// Pauses the host, from a moment when no byte is on its way.
  void skip(double duration) {
    run(kLook);  // takes the reply to the last frame; the next is not due
    looks_ += std::lround(duration / kLook);
  }

  /// The host decides on a frame, and sends it `duration` later.
  void sendLate(double duration) {
    send_late_ = std::lround(duration / kLook);
    while (send_late_ > 0) run(kLook);
  }

  /// Moves the held grip out and back slowly, 0.5 mm in a millisecond, so that no jump is seen.
  void pull(double out, const std::function<void(double)>& each = nullptr) {
    const Vec3 from_D = emulator.plant().position();
    const int steps = static_cast<int>(std::ceil(out / 0.0005));
    for (int i = 1; i <= 2 * steps; ++i) {
      const double share = 1.0 - std::abs(i - steps) / static_cast<double>(steps);
      emulator.plant().hold(Vec3(from_D + share * Vec3(0.0, 0.0, out)));
      run(0.001, each);
    }
    emulator.plant().hold(std::nullopt);
  }

  [[nodiscard]] double now() const { return static_cast<double>(looks_) * kLook; }

  FalconEmulator emulator;
  FalconDriver driver;

 private:
  void look() {
    if (emulator.isPluggedIn() != is_connected_) {
      is_connected_ = emulator.isPluggedIn();
      if (is_connected_)
        driver.connect(now());
      else
        driver.disconnect(FalconFault::kUnplugged, now());
    }
    if (!is_connected_) return;
    std::array<std::uint8_t, 256> bytes{};
    const std::size_t come = emulator.collect(bytes.data(), bytes.size(), now());
    driver.take(bytes.data(), come, now());
    const LineStep step = driver.advance(now());
    if (step.count > 0) looks_ += std::exchange(send_late_, 0);
    if (step.line) emulator.setLine(*step.line);
    if (step.purges) emulator.purge();
    if (step.count > 0) emulator.take(step.bytes.data(), step.count, now());
  }

  long looks_ = 0, send_late_ = 0;
  bool is_connected_ = false;
};

}  // namespace tandem::test
