#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/scenes/bench_scene.h"

/// \file
/// How a way to simulate takes part in `tandem bench accuracy`.
///
/// To add one: write bench/methods/<name>.cpp with a class derived from Simulation that sets the
/// scene up in its constructor and moves it on in step(), and one derived from Method that makes
/// it; declare its factory in methods/all_methods.h and list it in methods/all_methods.cpp. The
/// build finds the file; runs, timing, errors, tables and figures are the bench's. Its colour and
/// marker in figures go into demos/program/plot/benches.py.
namespace tandem::demos::bench {

/// A scene that a method cannot run, and why: one line for the table.
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

  /// Moves everything on by one host step. Nothing but this is timed.
  virtual void step() = 0;

  /// What the host's world holds now, at the end of the latest step. `state` is of the right size.
  virtual void read(SceneState& state) const = 0;

  /// Switches to keeping what tickSamples() gives; called before the first step if at all.
  virtual void keepTicks() {}
  /// Tools at the haptic ticks so far, for methods that know them between host steps.
  [[nodiscard]] virtual std::vector<TickSample> tickSamples() const { return {}; }
};

/// A way to simulate. Stateless.
class Method {
 public:
  virtual ~Method() = default;
  [[nodiscard]] virtual std::string name() const = 0;

  /// Sets a scene up at `host_rate` [Hz] steps per second. Throws NotApplicable, or whatever the
  /// engine throws, when it cannot: the message becomes the reason in the table.
  [[nodiscard]] virtual std::unique_ptr<Simulation> start(const BenchScene& scene,
                                                          int host_rate) const = 0;
};

}  // namespace tandem::demos::bench
