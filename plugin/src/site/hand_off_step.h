#pragma once

#include "site/island_step.h"

namespace tandem {

// clang-format off
/// The island moves the bodies, and Bullet gets their average velocity over its step.
///
///              host's thread                          thread that ticks
///   pre-tick   look: how the host changed its bodies  goIn: the island takes them, moves on
///              hand off their states at the end
///   Bullet     steps
///   post-tick  take back its solver's impulses        goOut: the island takes them;
///              look around                            neighbours enter and leave
///
/// With a haptic thread each request waits for the running tick, one period at most.
// clang-format on
class HandOffStep final : public IslandStep {
 public:
  explicit HandOffStep(SiteParts& parts);

  void addObject(SharedObject& object) override;
  void finishSetUp() override;
  void beginLive() override { lookAround(site_.clock.expectedStep()); }
  void makeUp(double now, double most) noexcept override;
  void advance(double now, double end) noexcept override;
  /// Nothing to do: the next hand-off shows it in Bullet.
  void showProxy(Peer&) noexcept override {}
  void before(double dt) noexcept override;
  void after(double dt) noexcept override;

 private:
  // In the tick.
  void moveTo(double until) noexcept;
  void loseTime(double until) noexcept;
  // In the host's thread.
  [[nodiscard]] bool hasNoTicks() const noexcept;
  void leaveAlone(double dt) noexcept;
  bool findChanges() noexcept;
  void renewObjects(double dt);
  void giveBack();
  [[nodiscard]] static bool hasItsShare(const SiteBody& body) noexcept;
  void stopSleepers() noexcept;
  void lookAtBodies(double dt) noexcept;
  void lookAroundNews();
  void handOff(double dt) noexcept;
  void takeBack(double dt);
  void restore(SiteBody& body) noexcept;
  void showPuts() noexcept;
  void lookFarther();
  void fallQuiet();
  // In the thread that ticks, at the request of the host's thread.
  void goIn(double dt, bool looks_quiet) noexcept;
  void restOn(double dt) noexcept;
  void passHostChanges(double dt) noexcept;
  void moveBody(SiteBody& body, const HostChange& change) noexcept;
  void takeStops() noexcept;
  void findEnds() noexcept;
  void findShares() noexcept;
  void takeMasses() noexcept;
  void goOut(double dt) noexcept;
  void takePuts() noexcept;

  double step_end_ = 0.0;  ///< of the host's present step [s]
  bool is_alone_ = false;  ///< nobody ticks: all bodies are Bullet's
};

}  // namespace tandem
