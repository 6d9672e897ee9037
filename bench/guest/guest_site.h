#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tandem/plugin/site.h"

#include "bench/guest/guest_hand.h"
#include "bench/guest/guest_journal.h"
#include "bench/guest/guest_world.h"

namespace tandem::demos::bench {

/// A host with a site, and a twin of its world without one. Both get the same acts.
class GuestSite {
 public:
  GuestSite(const GuestCase& one, int self);

  [[nodiscard]] GuestWorld& world() { return world_; }
  [[nodiscard]] GuestWorld& twin() { return twin_; }
  [[nodiscard]] GuestDevice& device() { return device_; }
  [[nodiscard]] Site* site() { return site_.get(); }

  /// All sites connect before the first step.
  void connect(int other, Link& link);

  void doAct(const GuestActPlan& plan);
  /// Lists all that was done to the twin, in all frames that have ended.
  [[nodiscard]] const GuestJournal& journal() const { return journal_; }
  /// Energy that acts in callbacks, and resets of peers, gave since the last call [J].
  [[nodiscard]] double takeGiven() { return std::exchange(given_, 0.0); }
  /// One frame of both worlds that begins at `time`, with the ticks of its caller.
  void step(double time);

  /// @name Acts on the site, and its end.
  /// @{
  void unshare(Draw& draw);
  void shareAgain(Draw& draw);
  void beginAnother();
  void changeHand(Draw& draw);
  void end();
  /// @}

  /// The first thing that a site that ended has not restored; empty if there is none.
  [[nodiscard]] std::string findLeftOver();
  /// The same of sites that ended before, while their world went on.
  [[nodiscard]] const std::string& leftOver() const { return left_over_; }

 private:
  void begin();
  void noteHooks();
  [[nodiscard]] std::string findHookLeft();
  void doToTwin(const GuestFrame::Deed& deed);
  void findPlaces();
  void followResets();

  const GuestCase& case_;
  int self_;
  GuestWorld world_, twin_;
  GuestDevice device_;
  std::vector<std::pair<int, Link*>> links_;
  std::unique_ptr<Site> site_;
  std::vector<GuestActPlan> pending_;
  GuestJournal journal_;
  GuestFrame frame_;          ///< that has not ended
  std::vector<Vec3> places_;  ///< of bodies before the step
  std::string left_over_;
  std::uint64_t ticks_ = 0;
  double simulated_ = 0.0;  ///< by the host [s]
  double given_ = 0.0;
  btInternalTickCallback pre_tick_ = nullptr, post_tick_ = nullptr;
  const void* user_ = nullptr;
  const void* islands_ = nullptr;
};

/// Settings in which two bodies differ that should be equal; empty if there is none. Poses,
/// velocities and sleep are not compared.
[[nodiscard]] std::string compareSettings(GuestWorld& world, GuestWorld& twin, std::size_t body);

}  // namespace tandem::demos::bench
