#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/guest/guest_run.h"
#include "bench/guest/guest_shaken.h"
#include "bench/guest/guest_site.h"

namespace tandem::demos::bench {

struct GuestFinding {
  GuestFailure failure = GuestFailure::kNone;
  std::string text;
};

/// Judges the worlds of a case while it runs.
///
/// Energy: motion and weight of all bodies of all sites is at most three times what came in. That
/// is what the twins gained, what acts gave, what hands did, and some for movers. What acts gave
/// includes the energy of joints that they tore open.
///
/// Before a case fails by energy, or as a body fell, shaken twins are asked: it is good if it is
/// with one of them in the twin's place.
class GuestVerdict {
 public:
  GuestVerdict(const GuestCase& one, std::vector<std::unique_ptr<GuestSite>>& sites);

  /// Around the acts of a step, which may give energy to bodies of sites and twins.
  void beforeActs();
  void afterActs();
  /// After a step of all worlds. The first thing that broke, or nothing.
  [[nodiscard]] std::optional<GuestFinding> look();
  /// After the end of all sites.
  [[nodiscard]] std::optional<GuestFinding> lookAtEnd();

  /// Largest share of the allowed energy so far.
  [[nodiscard]] double energyShare() const { return share_; }

 private:
  [[nodiscard]] std::optional<GuestFinding> findNotFinite(GuestSite& site) const;
  [[nodiscard]] std::optional<GuestFinding> findFallen(std::size_t index);
  [[nodiscard]] std::optional<GuestFinding> findDifferent(std::size_t index);
  [[nodiscard]] std::optional<GuestFinding> findEnergy();
  void allowTwins(double energy);
  /// Adds what motors, and the host's torques and forces on arms, may have given in a frame.
  void allowArms();
  [[nodiscard]] const ShakenTwins& askShaken();
  [[nodiscard]] bool isArmNearHand(GuestSite& site, double near) const;
  void excuse(GuestWorld& world) const;
  void excuseSunk(GuestWorld& twin) const;

  const GuestCase& case_;
  std::vector<std::unique_ptr<GuestSite>>& sites_;
  double allowed_ = 0.0, share_ = 0.0;
  bool diverges_ = false;  ///< a joint or tie that gives energy in Bullet alone
  double fastest_ = 1.0;   ///< body or proxy so far [m/s]
  double motors_ = 0.0;    ///< they could do this at the speeds before the frame [J]
  double before_ = 0.0, twins_ = 0.0;
  double rails_ = 0.0;  ///< the most that movers may have given to bodies on rails [J]
  bool has_mover_ = false;
  double gained_ = 0.0;  ///< by the twins; part of `allowed_` [J]
  ShakenTwins shaken_;
  std::vector<char> has_felt_;             ///< by site: a hand that feels bodies had one near
  std::vector<std::vector<char>> is_met_;  ///< by site and body: something came near a far body
};

}  // namespace tandem::demos::bench
