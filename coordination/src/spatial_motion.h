#pragma once

#include <vector>

#include "island_model.h"
#include "linear_map.h"
#include "touch.h"

namespace tandem {

/// Motion of a free island in three dimensions.
///
///   alone with its couplers   -> exact map, axis by axis (LinearMap of one degree of freedom)
///   in reach of a contact     -> Runge-Kutta 4 at the inner step, make and break located in the
///   step near rigid obstacles      -> the same, then RigidContacts corrects each inner step
///
/// A body counts as alone while nothing can reach it within the time asked for; if the end shows
/// that something did, the time is done again as a contact.
class SpatialMotion {
 public:
  /// Allocates.
  explicit SpatialMotion(const IslandModel& model);

  /// Real-time safe.
  void advance(IslandModel& model, double dt) noexcept;

 private:
  struct Rates {
    Vec3 v, a, alpha;
    Eigen::Vector4d q_dot;
  };

  void findLoners(const IslandModel& model, double dt) noexcept;
  void advanceAlone(const IslandModel& model, double dt) noexcept;
  [[nodiscard]] bool wasAlone(const IslandModel& model) const noexcept;
  template <typename IsNear>
  void collectTouches(const IslandModel& model, IsNear is_near) noexcept;
  void advanceTogether(const IslandModel& model, double dt) noexcept;
  void advanceSmoothly(const IslandModel& model, double h) noexcept;
  double locateEvent(const IslandModel& model, double h) noexcept;
  void rungeKutta(const IslandModel& model, const States& from, double h, States& to) noexcept;
  void computeRates(const IslandModel& model, const States& states,
                    std::vector<Rates>& rates) noexcept;
  void setStage(const IslandModel& model, const States& from, const std::vector<Rates>& rates,
                double h, States& to) const noexcept;
  void updateModes(const IslandModel& model, const States& states) noexcept;
  [[nodiscard]] double computeGuard(const IslandModel& model, const Touch& touch,
                                    const States& states) const noexcept;
  void correctRigid(const IslandModel& model, double h) noexcept;

  std::vector<LinearMap> alone_maps_;  ///< per body; empty for those that forces do not move
  std::vector<char> alone_;            ///< per body: translation by its exact map
  std::vector<char> together_;    ///< per body: by Runge-Kutta (also the rotation of one alone)
  std::vector<char> rigid_near_;  ///< per body
  std::vector<Touch> touches_;    ///< in reach
  double inner_step_;

  // Working memory of a step, by body.
  States states_, start_, next_, before_rigid_;
  std::vector<Rates> k1_, k2_, k3_, k4_;
  std::vector<Wrench> wrenches_;
  std::vector<double> guards_;  ///< by touch, at the start of a step
};

}  // namespace tandem
