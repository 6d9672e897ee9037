#pragma once

#include <memory>
#include <string>

#include "bench/speed/speed_world.h"

namespace tandem::demos::bench {

/// Time of some host steps and of their haptic ticks [us].
struct SpeedTimes {
  double host = 0.0;
  double ticks = 0.0;
  int host_steps = 0;
  int tick_count = 0;
};

/// A scene that runs in one way.
class SpeedRun {
 public:
  virtual ~SpeedRun() = default;
  /// Steps per second of the host [Hz].
  [[nodiscard]] virtual int hostRate() const = 0;
  /// Times one host step with its ticks.
  virtual void step(SpeedTimes& times) = 0;
};

/// Way to simulate.
enum class SpeedWay {
  kBare60,   ///< Bullet at 60 Hz, no hand touches anything
  kBare240,  ///< the same at 240 Hz
  kWhole,    ///< Bullet at 1 kHz; contact forces are impulses in its pre-tick
  kIsland,   ///< Bullet at 60 Hz with a Site, ticked at 1 kHz
};

[[nodiscard]] std::string nameOf(SpeedWay way);

/// Builds the world and lets it settle.
[[nodiscard]] std::unique_ptr<SpeedRun> startSpeedRun(const SpeedScene& scene, SpeedWay way);

}  // namespace tandem::demos::bench
