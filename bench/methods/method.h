#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/scenes/bench_scene.h"

/// \file
/// Methods that `tandem bench accuracy` compares.
///
/// To add one, write bench/methods/<name>.cpp. A class derived from Simulation sets the scene up in
/// its constructor and advances it in step(); a class derived from Method makes it. Declare the
/// factory in methods/all_methods.h and list it in methods/all_methods.cpp. The build finds the
/// file. The bench provides runs, timing, errors, tables and figures. Colour and marker in figures
/// go into demos/program/plot/benches.py.
namespace tandem::demos::bench {

/// Thrown for a scene that a method cannot run; the reason is one line for the table.
class NotApplicable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// State of one tool at the start of tick `tick` (at tick / kTargetRate s).
struct TickSample {
  std::uint64_t tick = 0;
  int tool = 0;
  PointState state;
};

/// One scene being run by one method at one host step.
class Simulation {
 public:
  virtual ~Simulation() = default;

  /// Advances all bodies by one host step. Only this is timed.
  virtual void step() = 0;

  /// State of the host's world at the end of the latest step. `state` has the right size.
  virtual void read(SceneState& state) const = 0;

  /// Starts keeping the states for tickSamples(). Call it before the first step.
  virtual void keepTicks() {}
  /// Tools at the haptic ticks so far, for methods that know them between host steps.
  [[nodiscard]] virtual std::vector<TickSample> tickSamples() const { return {}; }
};

/// A method of simulation. Stateless.
class Method {
 public:
  virtual ~Method() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// True for what a host can do with Bullet alone; the table sets hand-off beside the best of it.
  [[nodiscard]] virtual bool isBulletAlone() const { return false; }

  /// Sets a scene up at `host_rate` [Hz] steps per second. Throws NotApplicable, or the engine's
  /// exception, if it cannot. The message becomes the reason in the table.
  [[nodiscard]] virtual std::unique_ptr<Simulation> start(const BenchScene& scene,
                                                          int host_rate) const = 0;
};

}  // namespace tandem::demos::bench
