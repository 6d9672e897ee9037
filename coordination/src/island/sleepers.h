#pragma once

#include <vector>

#include "island/touch.h"

namespace tandem {

/// Bodies of an island that are at rest with nothing near them: left out of everything until
/// something comes. They cost nothing, however many they are.
///
///   a call changes one             -> Island wakes it
///   a sphere comes near            -> wakeNear(): each sphere knows how far it may go before it
///                                     must look again
///   something rigid comes near     -> the ContactFinder's lookAround(), as for all that rests
///
/// Spheres that touch others and bodies in slots never sleep alone: they are few.
class Sleepers {
 public:
  /// Allocates.
  explicit Sleepers(const IslandModel& model);

  /// Puts a body to sleep if no sphere is near. `allowance` as in wakeNear().
  void letSleep(IslandModel& model, const States& states, const std::vector<double>& allowance,
                BodyIndex body) noexcept;

  /// Wakes those that a sphere may reach if no part of a body goes farther than its allowance [m];
  /// true if there were any.
  bool wakeNear(IslandModel& model, const States& states,
                const std::vector<double>& allowance) noexcept;

 private:
  /// A sphere, and what it might touch.
  struct Watcher {
    BodyIndex sphere;
    std::vector<BodyIndex> partners;
    Vec3 p_W = Vec3::Zero();  ///< where it looked last
    double free_way = 0.0;    ///< from there, without meeting a sleeper [m]
  };
  void look(IslandModel& model, const States& states, double reach, Watcher& watcher) noexcept;

  std::vector<Watcher> watchers_;
};

}  // namespace tandem
