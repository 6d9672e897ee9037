#pragma once

#include <memory>
#include <string>

#include "bench/speed/speed_world.h"

namespace tandem::demos::bench {

/// Time taken by some host steps and the haptic ticks that belong to them [us].
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
  /// One host step with what belongs to it, timed.
  virtual void step(SpeedTimes& times) = 0;
};

/// How to simulate.
enum class SpeedWay {
  kBare60,   ///< Bullet at 60 Hz, nobody touches anything
  kBare240,  ///< the same at 240 Hz
  kWhole,    ///< Bullet at 1 kHz with the forces of the touch as impulses in its pre-tick
  kIsland,   ///< Bullet at 60 Hz with a Site, ticked at 1 kHz
};

[[nodiscard]] std::string nameOf(SpeedWay way);

/// Builds the world and lets it settle.
[[nodiscard]] std::unique_ptr<SpeedRun> startSpeedRun(const SpeedScene& scene, SpeedWay way);

}  // namespace tandem::demos::bench
