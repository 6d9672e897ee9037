#pragma once

#include <vector>

#include "island/island_model.h"
#include "island/linear_map.h"
#include "island/linear_series.h"

namespace tandem {

/// Motion of a guided island: everything on one line, linear between events, therefore exact.
///
/// Coordinates are displacements along the guide from where bodies were at set-up. A contact's side
/// is fixed there, too: bodies in a slot keep their order. Which contacts push is the island's
/// mode; one LinearMap per mode. A step that changes the mode is descended into by halves until the
/// event stands within T/2^31. While some share is below 1, a body is a ghost or has extra damping,
/// a LinearSeries takes the place of the maps.
class SlotMotion {
 public:
  /// More contacts than this make too many modes (2^n maps).
  static constexpr int kMaxContacts = 4;

  /// Allocates. Throws std::invalid_argument beyond kMaxContacts.
  explicit SlotMotion(const IslandModel& model);

  /// Looks again at shares, ghosts and extra damping. Real-time safe.
  void refit(const IslandModel& model) noexcept;

  /// Real-time safe.
  void advance(IslandModel& model, double dt) noexcept;

  /// How deep a body is in what it could touch, ghosts apart [m]; 0 or less: in nothing.
  [[nodiscard]] double computeOverlap(const IslandModel& model, BodyIndex body) const noexcept;

  /// Contact force on a body along the guide at this instant [N].
  [[nodiscard]] double computeContactForce(const IslandModel& model, BodyIndex body) const noexcept;

 private:
  struct Contact {
    BodyIndex sphere, other;
    CouplerGains gains;    ///< times the share
    double side = 1.0;     ///< +1: the sphere pushes `other` along +guide
    double clearance = 0;  ///< gap at zero displacements [m]
    CouplerGains full_gains;
  };
  struct Overlap {
    double depth, rate;
  };
  /// What came of trying a step; all but the first left the state as it was.
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
  LinearSeries series_;          ///< in place of them
  bool is_altered_ = false;      ///< something is not as it was built
  int coarsest_level_ = 0;  ///< steps never longer than T/2^this: no contact made and broken unseen

  // Working memory of a step.
  std::vector<double> state_, next_, u_, w_;
  std::vector<double> driven_x_, driven_v_, driven_rate_;  ///< per body without a degree of freedom
};

}  // namespace tandem
