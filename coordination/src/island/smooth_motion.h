#pragma once

#include <Eigen/Core>

#include "tandem/coordination/island_counters.h"

#include "island/smooth_forces.h"

namespace tandem {

/// Moves bodies in contact by Runge-Kutta 5(4), with an error bound per step. Contacts made and
/// broken are located inside the step. With joints, 4(3) is tried first: it has fewer stages.
///
/// A step is as long as its error allows (IslandSettings::tolerance): a whole haptic period in a
/// soft scene. It ends just behind the first change of a contact, so that no step spans one.
class SmoothMotion {
 public:
  /// Allocates.
  SmoothMotion(const IslandModel& model, std::size_t max_touches, JointForces& joints);

  /// Recomputes the limits from gains and masses, after a slot was filled or cleared.
  void chooseLimits(const IslandModel& model) noexcept;

  /// Longest step over which a force that is held may act beside springs [s]: the fastest of them
  /// turns by half a radian at most.
  [[nodiscard]] double longestHold() const noexcept { return longest_hold_; }

  /// Selects the bodies that move from now on, see SmoothForces::choose.
  void choose(const IslandModel& model, const std::vector<char>& together,
              const std::vector<char>& alone, const std::vector<Touch>& touches) noexcept;

  /// Sets extra forces, by body, for the coming advance(): SmoothForces::hold.
  void hold(const std::vector<HeldWrench>& held) noexcept { forces_.hold(held); }

  /// Moves the chosen bodies by `dt` [s]. Real-time safe; the number of steps is bounded.
  void advance(States& states, double dt, IslandCounters& counters) noexcept;

 private:
  /// Values of a touch at the start of a step.
  struct Start {
    double overlap, rate, guard;
    int under;
  };

  void tryStep(double from, double h) noexcept;
  [[nodiscard]] double estimateError(double h) noexcept;
  void tryStepOfOrder4(double from, double h) noexcept;
  [[nodiscard]] double estimateErrorOfOrder4(double h) noexcept;
  [[nodiscard]] double measureError(const double* e) const noexcept;
  [[nodiscard]] bool acceptsStep(double h, double error) noexcept;
  [[nodiscard]] double divideEvenly(double rest) const noexcept;
  [[nodiscard]] bool hasPassedEdge() const noexcept;
  /// A step as short as this is accepted whatever its error [s].
  [[nodiscard]] double computeShortestStep() const noexcept;
  double takeStep(double from, double rest, IslandCounters& counters) noexcept;
  [[nodiscard]] bool hasChanged() const noexcept;
  [[nodiscard]] double findHiddenTouch(double h) const noexcept;
  double locateChange(double from, double h, IslandCounters& counters) noexcept;
  void rememberStart() noexcept;

  SmoothForces forces_;
  double period_, tolerance_;
  double allowed_error_ = 0.0;  ///< of one step [m]
  double answer_ = 0.0;         ///< response time of springs to an error of velocity [s]
  double max_step_ = 0.0;       ///< stable, and resolves the fastest oscillation [s]
  double longest_hold_ = 0.0;   ///< of rigid contact [s]
  double min_step_ = 0.0;       ///< shorter steps are accepted whatever their error [s]
  double step_ = 0.0;           ///< last good length [s]
  int steps_of_order_5_ = 0;    ///< to be done before one of order 4 is tried
  Eigen::ArrayXd y_, next_, k_[7];
  std::vector<Start> starts_;  ///< by touch
};

}  // namespace tandem
