#pragma once

#include <vector>

#include "coordination/src/island/island.h"
#include "site/moments.h"
#include "site/rest_mark.h"
#include "site/snapshots.h"

namespace tandem {

/// The island's time: ticks, the moments inside a tick at which steps of the host end, and states
/// of the past, which a late host asks for.
///
///     tick start         host's step ends                      tick end
///         |---- moveTo -------o---------------- moveTo ------------|
///      keepStart       states are kept                    time() is here
///
/// Owned by whoever ticks. Real-time safe but where it says that it allocates.
class Timeline {
 public:
  /// `period` of the ticks and the expected `host_step` [s]; 0: not known.
  Timeline(Island& island, double period, double host_step) noexcept;

  /// After set-up: all states are news. Allocates.
  void setBodyCount(std::size_t count);
  /// Room for the states at the ends of this many steps of the host. Allocates.
  void makeRoom(std::size_t moments) { snapshots_.makeRoom(moments); }
  [[nodiscard]] std::size_t room() const noexcept { return snapshots_.room(); }

  /// The first tick is at `now`. The host's clock goes on by `host_shift`.
  void begin(double now, double host_shift) noexcept;
  void startTick(double now) noexcept { tick_start_ = now; }
  void endTick() noexcept { ++ticks_; }

  [[nodiscard]] double period() const noexcept { return period_; }
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_; }
  [[nodiscard]] bool hasBegun() const noexcept { return ticks_ > 0; }
  [[nodiscard]] double start() const noexcept { return start_; }
  [[nodiscard]] double tickStart() const noexcept { return tick_start_; }
  /// Up to where the island has been moved [s].
  [[nodiscard]] double time() const noexcept { return time_; }
  /// When the next tick is due [s]; the first one is at `first`.
  [[nodiscard]] double nextTick(double first) const noexcept {
    return hasBegun() ? start_ + static_cast<double>(ticks_) * period_ : first;
  }

  /// Keeps the states at the start of a tick.
  void keepStart() noexcept;
  /// Moves the island on to `until`, a period at the most, and keeps the states at the announced
  /// end of a host's step.
  void moveTo(double until) noexcept;
  /// Without the island: somebody else moves the bodies.
  void passTo(double until) noexcept { time_ = until; }
  /// Time that nobody has had: no step of the host ends in it.
  void lose(double until) noexcept;

  /// The host's steps of length `step` end at `end`, and so on [s].
  void announce(double end, double step) noexcept;
  /// The first of these ends that the island has not passed.
  void announceAfterNow(double end, double step) noexcept;
  [[nodiscard]] double announcedEnd() const noexcept { return step_end_; }

  /// The states kept at `time`, or null.
  [[nodiscard]] std::vector<RigidState>* findStates(double time) noexcept {
    return snapshots_.find(time, kClockTolerance);
  }
  /// A body at a moment that nobody had announced: cubic between the ends of the latest tick, or
  /// between the nearest moments that were kept. Right to w^4 h^4 / 384 of the motion.
  [[nodiscard]] RigidState stateAt(BodyIndex body, double time) noexcept;
  /// All bodies at a moment, by index.
  void readStates(double time, std::vector<RigidState>& states) noexcept;
  /// The earliest kept moment later than `time` [s]; infinity without one.
  [[nodiscard]] double nextKeptAfter(double time) const noexcept {
    return snapshots_.nextAfter(time);
  }
  /// Calls `change` with the body's state now and with each that is kept for later than `time`.
  template <typename Change>
  void changeAfter(double time, BodyIndex body, Change change) noexcept {
    island_.setState(body, change(island_.state(body)));
    snapshots_.forEachAfter(time, [&](std::vector<RigidState>& states) {
      RigidState& state = states[static_cast<std::size_t>(body)];
      state = change(state);
    });
  }
  /// A body that has come into the island during the tick.
  void setStart(BodyIndex body, const RigidState& state) noexcept {
    start_states_[static_cast<std::size_t>(body)] = state;
  }

  /// True if nothing has moved since the tick's start.
  [[nodiscard]] bool sleptSinceStart() const noexcept { return start_rest_.holds(island_); }
  /// Calls `visit(body, its state at the tick's start)` for each body awake then.
  template <typename Visit>
  void forEachMoved(Visit visit) const noexcept {
    for (const BodyIndex b : moved_) visit(b, start_states_[static_cast<std::size_t>(b)]);
  }

 private:
  void keepStates(double time) noexcept;

  Island& island_;
  double period_, host_step_;
  double start_ = 0.0, time_ = 0.0, tick_start_ = 0.0;
  std::uint64_t ticks_ = 0;
  double step_end_;  ///< next moment at which a step of the host ends
  Snapshots snapshots_;
  std::vector<RigidState> start_states_;
  std::vector<BodyIndex> moved_;  ///< awake when the latest tick began
  RestMark start_rest_, snapshot_rest_;
};

/// Where a body was that goes steadily to `end` in dt.
[[nodiscard]] inline RigidState computeStart(RigidState end, double dt) noexcept {
  end.p_W -= dt * end.v_W;
  return end;
}

}  // namespace tandem
