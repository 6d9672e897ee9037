#pragma once

#include <vector>

#include "island/island.h"
#include "island/island_model.h"
#include "island/spatial_motion.h"

namespace tandem {

/// Moves some bodies of an island through a time that the others have behind them; see
/// Island::catchUp(). The others take part with their mass and known path. They receive momentum
/// from the newcomers they touch, but no force acts on them twice.
class IslandCatchUp {
 public:
  /// May allocate.
  void prepare(const IslandModel& model);

  void run(IslandModel& model, SpatialMotion& motion, IslandCounters& counters,
           const std::vector<BodyIndex>& slots, const std::vector<RigidState>& from,
           const std::vector<RigidState>& to, double duration, std::vector<Aside>& asides) noexcept;

 private:
  void setAside(IslandModel& model, const std::vector<BodyIndex>& slots) noexcept;
  void takeBack(IslandModel& model) noexcept;
  void swapPast(IslandModel& model) noexcept;
  void sendAlong(IslandModel& model, BodyIndex b, const Aside& steady, const RigidState& from,
                 const Aside& aside) noexcept;
  void bringBack(IslandModel& model, BodyIndex b, const Aside& steady, const RigidState& to,
                 Aside& aside) noexcept;

  std::vector<ModelBody> bodies_;
  std::vector<ModelCoupler> couplers_;
  std::vector<IslandContact> contacts_;
  std::vector<ModelGrip> grips_;
  std::vector<BodyIndex> slots_;
  TouchedFaces faces_;
  const std::vector<Obstacle>* obstacles_ = nullptr;
  States states_;
};

}  // namespace tandem
