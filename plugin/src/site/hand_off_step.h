#pragma once

#include "site/island_step.h"

namespace tandem {

/// The island moves the bodies, and Bullet gets their average velocity over its step.
///
///                host's thread                                asked of whoever ticks
///   pre-tick     look: what the host did to its bodies        goIn: the island gets it and moves
///   on
///                hand off where they are at the step's end
///   Bullet       steps
///   post-tick    take back what its solver did                goOut: the island gets it, and who
///                look around                                  comes and goes does so
///
/// With a haptic thread each asking waits for it, a period at the most.
class HandOffStep final : public IslandStep {
 public:
  explicit HandOffStep(SiteParts& parts);

  void addObject(SharedObject& object) override;
  void finishSetUp() override;
  void beginLive() override { lookAround(site_.clock.expectedStep()); }
  void makeUp(double now, double most) noexcept override;
  void advance(double now, double end) noexcept override;
  /// The next hand-off tells Bullet.
  void showProxy(Peer&) noexcept override {}
  void before(double dt) noexcept override;
  void after(double dt) noexcept override;

 private:
  // In the tick.
  void moveTo(double until) noexcept;
  void loseTime(double until) noexcept;
  // In the host's thread.
  void lookAtBodies(double dt) noexcept;
  void handOff(double dt) noexcept;
  void takeBack(SiteBody& body) noexcept;
  void lookFarther();
  void fallQuiet();
  // Asked of whoever ticks.
  void goIn(double dt, bool looks_quiet) noexcept;
  void restOn(double dt) noexcept;
  void passHostChanges(double dt) noexcept;
  void moveBody(const SiteBody& body, const HostChange& change) noexcept;
  void findEnds() noexcept;
  void goOut(double dt) noexcept;
  void receive(SiteBody& body) noexcept;

  double step_end_ = 0.0;  ///< of the host's present step [s]
};

}  // namespace tandem
