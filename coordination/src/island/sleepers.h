#pragma once

#include <vector>

#include "island/touch.h"

namespace tandem {

/// Bodies of an island at rest with nothing near. They are skipped until something comes, and cost
/// nothing, however many there are.
///
///   a call changes one             -> Island wakes it
///   a sphere comes near            -> wakeNear(): each sphere knows how far it may move before it
///                                     must search again
///   a rigid body comes near        -> the ContactFinder's lookAround(), as for all bodies at rest
///
/// Spheres with contacts and bodies in slots never sleep alone: there are few of them.
class Sleepers {
 public:
  /// Allocates.
  explicit Sleepers(const IslandModel& model);

  /// Puts a body to sleep if no sphere is near. `allowance` as in wakeNear().
  void letSleep(IslandModel& model, const States& states, const std::vector<double>& allowance,
                BodyIndex body) noexcept;

  /// Wakes the bodies that a sphere may reach while no body moves farther than its allowance [m].
  /// True if there were any.
  bool wakeNear(IslandModel& model, const States& states,
                const std::vector<double>& allowance) noexcept;

 private:
  /// A sphere and the bodies it might touch.
  struct Watcher {
    BodyIndex sphere;
    std::vector<BodyIndex> partners;
    Vec3 p_W = Vec3::Zero();  ///< position at the last search
    double free_way = 0.0;    ///< distance from there without a sleeper [m]
  };
  void look(IslandModel& model, const States& states, double reach, Watcher& watcher) noexcept;

  std::vector<Watcher> watchers_;
};

}  // namespace tandem
