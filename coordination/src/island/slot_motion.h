#pragma once

#include <vector>

#include "island/island_model.h"
#include "island/linear_map.h"
#include "island/linear_series.h"

namespace tandem {

/// Motion of a guided island: everything moves along one direction, linear between events, and
/// therefore exact.
///
/// Coordinates are displacements along the guide from the positions at set-up. A contact's side is
/// fixed at set-up, because bodies keep their order. The set of contacts that push is the island's
/// mode; each mode has one LinearMap. A step that changes the mode is halved until the event is
/// located within T/2^31. A LinearSeries replaces the maps while a share is below 1, or a body is a
/// ghost or has extra damping, and where there are too many modes for maps.
class SlotMotion {
 public:
  /// Most contacts of a guided island: bits of a mode.
  static constexpr int kMaxContacts = 31;
  /// With more, there are no maps; n contacts make 2^n.
  static constexpr int kMaxMappedContacts = 4;

  /// Allocates. Throws std::invalid_argument beyond kMaxContacts.
  explicit SlotMotion(const IslandModel& model);

  /// Updates for changed shares, ghosts, masses and damping. Real-time safe.
  void refit(const IslandModel& model) noexcept;

  /// Takes over the allowances in the model's memory. Real-time safe.
  void recall(const IslandModel& model) noexcept;

  /// The model's positions were shifted. Real-time safe.
  void shiftOrigin(const Vec3& offset_W) noexcept {
    for (Vec3& origin_W : origins_) origin_W += offset_W;
  }

  /// Real-time safe.
  void advance(IslandModel& model, double dt) noexcept;

  /// Deepest overlap of a body with its contact partners except ghosts [m]; <= 0 if none.
  [[nodiscard]] double computeOverlap(const IslandModel& model, BodyIndex body) const noexcept;

  /// Contact force on a body along the guide at this instant [N].
  [[nodiscard]] double computeContactForce(const IslandModel& model, BodyIndex body) const noexcept;

 private:
  struct Contact {
    BodyIndex sphere, other;
    CouplerGains gains;    ///< gains times the share
    double side = 1.0;     ///< +1: the sphere pushes `other` along +guide
    double clearance = 0;  ///< gap at zero displacements, and the allowance [m]
    CouplerGains full_gains;
    double full_clearance = 0;  ///< without the allowance [m]
  };
  struct Overlap {
    double depth, rate;
  };
  struct Inertia {
    double mass, damping;
  };
  /// Result of trying a step; all but the first leave the state unchanged.
  enum class Step { kTaken, kCrossesEvent, kHidesTouch };

  [[nodiscard]] double displacement(const ModelBody& body, BodyIndex index) const noexcept;
  [[nodiscard]] Overlap overlap(const IslandModel& model, const Contact& contact) const noexcept;
  [[nodiscard]] Overlap overlapAhead(const Contact& contact, const double* state,
                                     double ahead) const noexcept;
  [[nodiscard]] unsigned findMode(const double* state, double ahead) const noexcept;
  void gather(const IslandModel& model) noexcept;
  void tieSeries(const IslandModel& model, unsigned mode) noexcept;
  void computeInputs(const IslandModel& model, unsigned mode) noexcept;
  [[nodiscard]] bool hidesTouch(unsigned mode, double h) const noexcept;
  [[nodiscard]] Step tryStep(unsigned& mode, int level, bool may_change) noexcept;
  void advanceMovers(const IslandModel& model, double dt) noexcept;
  void scatter(IslandModel& model) const noexcept;

  Vec3 axis_;
  double period_;
  std::vector<Vec3> origins_;      ///< per body
  std::vector<int> freedom_;       ///< per body: its degree of freedom, or -1
  std::vector<BodyIndex> movers_;  ///< per degree of freedom: its body
  std::vector<Contact> contacts_;
  std::vector<LinearMap> maps_;  ///< per mode
  std::vector<Inertia> mapped_;  ///< per degree of freedom: of the maps
  LinearSeries series_;          ///< replaces the maps while uses_series_
  bool has_maps_ = true;
  bool uses_series_ = false;  ///< no maps, or something differs from what they were made of
  int coarsest_level_ = 0;    ///< steps are at most T/2^level, so no contact is missed

  // Working memory of a step.
  std::vector<double> state_, next_, u_, w_;
  std::vector<double> driven_x_, driven_v_, driven_rate_;  ///< per body without a degree of freedom
};

}  // namespace tandem
