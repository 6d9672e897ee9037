#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "tandem/plugin/haptic_loop.h"

#include "session/live_network.h"
#include "world/scene.h"

namespace tandem::view {

/// Both sites of a scenario in one process: two Bullet worlds, and a network between them. Sites
/// tick live, each in a haptic thread, or in virtual time by their caller. From one to the other
/// all states are kept; only stop() lets the forces fade. For the thread that steps the worlds,
/// besides network() and report().
class SitePair {
 public:
  /// The users are at `devices`, which must outlive this; null: simulated. Bodies begin at rest at
  /// `places`, or where the scenario says. Throws as SiteWorld does.
  explicit SitePair(const demos::Scenario& scenario,
                    const std::array<HapticDevice*, 2>& devices = {},
                    const demos::BodyPlaces& places = {});

  [[nodiscard]] demos::SiteWorld& own() noexcept { return own_; }
  [[nodiscard]] demos::SiteWorld& other() noexcept { return other_; }
  /// LiveNetwork::change() is for any thread.
  [[nodiscard]] LiveNetwork& network() noexcept { return network_; }

  // --- Live

  /// Starts the haptic threads, which go on from time(). Throws as HapticLoop does.
  void start();
  /// Lets the forces fade, and ends the threads. Does nothing without any.
  void stop() noexcept;
  [[nodiscard]] bool isLive() const noexcept { return loops_[0] != nullptr; }
  /// Time 0 of the sites on the monotonic clock [s].
  [[nodiscard]] double begin() const noexcept { return begin_; }
  /// Runs the host steps that end by `time` [s].
  void stepHosts(double time);
  /// Of user 1's haptic thread, which runs.
  [[nodiscard]] const HapticLoop& loop() const noexcept { return *loops_[0]; }
  /// Of the last haptic thread that ended at site 0 or 1.
  [[nodiscard]] const LoopReport& report(std::size_t site) const noexcept { return reports_[site]; }

  /// Gives the end of the `step`-th host step after time(), from 1 on [s].
  [[nodiscard]] double hostStepEnd(int step) const noexcept;

  // --- In virtual time

  /// Ticks both sites once, and then runs the host steps that end by time().
  void tick();
  /// Ticks until one more host step is done.
  void tickOneHostStep();
  [[nodiscard]] double period() const noexcept { return 1.0 / haptic_rate_; }
  /// Time that both sites have reached without threads [s].
  [[nodiscard]] double time() const noexcept;
  /// Of the next tick, if no thread runs.
  [[nodiscard]] std::uint64_t nextTick() const noexcept;

 private:
  void startLoop(int site);

  LiveNetwork network_;
  demos::SiteWorld own_, other_;
  double haptic_rate_, host_rate_;                ///< [Hz]
  std::array<std::uint64_t, 2> next_ticks_ = {};  ///< the sites' own, if no thread runs
  double begin_ = 0.0;
  std::array<LoopReport, 2> reports_ = {};
  std::array<std::unique_ptr<HapticLoop>, 2> loops_;
};

}  // namespace tandem::view
