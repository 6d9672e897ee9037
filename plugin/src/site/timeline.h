#pragma once

#include <vector>

#include "coordination/src/island/island.h"
#include "site/moments.h"
#include "site/rest_mark.h"
#include "site/snapshots.h"

namespace tandem {

// clang-format off
/// The island's time: ticks, ends of host steps inside a tick, and past states for a late host.
///
///     tick start         host's step ends                      tick end
///         |---- moveTo -------o---------------- moveTo ------------|
///      keepStart       states are kept                    time() is here
///
/// Owned by the thread that ticks. Real-time safe unless it says that it allocates.
// clang-format on
class Timeline {
 public:
  /// `period` of the ticks and expected `host_step` [s]; 0 if unknown.
  Timeline(Island& island, double period, double host_step) noexcept;

  /// After set-up: forgets that states were kept. New bodies have always been where they are.
  /// Allocates.
  void setBodyCount(std::size_t count);
  /// Makes room for the states at the ends of this many host steps. Allocates.
  void makeRoom(std::size_t moments) { snapshots_.makeRoom(moments); }
  [[nodiscard]] std::size_t room() const noexcept { return snapshots_.room(); }

  /// The first tick is at `now`; its states are kept. The host's clock is shifted by `host_shift`
  /// [s].
  void begin(double now, double host_shift) noexcept;
  void startTick(double now) noexcept { tick_start_ = now; }
  void endTick() noexcept { ++ticks_; }

  [[nodiscard]] double period() const noexcept { return period_; }
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_; }
  [[nodiscard]] bool hasBegun() const noexcept { return ticks_ > 0; }
  [[nodiscard]] double start() const noexcept { return start_; }
  [[nodiscard]] double tickStart() const noexcept { return tick_start_; }
  /// Time that the island has reached [s].
  [[nodiscard]] double time() const noexcept { return time_; }
  /// When the next tick is due [s]; `first` before the first tick.
  [[nodiscard]] double nextTick(double first) const noexcept {
    return hasBegun() ? start_ + static_cast<double>(ticks_) * period_ : first;
  }

  /// Keeps the states at the start of a tick.
  void keepStart() noexcept;
  /// Moves the island on to `until`, at most one period ahead. Keeps the states at an announced end
  /// of a host step.
  void moveTo(double until) noexcept;
  /// Moves only the time: Bullet moves the bodies.
  void passTo(double until) noexcept { time_ = until; }
  /// Skips lost time: no host step ends in it, and whoever asks for it gets the states of its end.
  void lose(double until) noexcept;

  /// Announces the end of a host step of length `step` [s]; further ends follow at that interval.
  void announce(double end, double step) noexcept;
  /// Like announce(), with the first such end after the island's time.
  void announceAfterNow(double end, double step) noexcept;
  [[nodiscard]] double announcedEnd() const noexcept { return step_end_; }

  /// The states kept at `time`, or null if there are none.
  [[nodiscard]] std::vector<RigidState>* findStates(double time) noexcept {
    return snapshots_.find(time, kClockTolerance);
  }
  /// State of a body at a moment that was not announced: cubic within the latest tick, or between
  /// the nearest kept moments. For motion at the angular frequency w and states h apart, the error
  /// is about w^4 h^4 / 384 of the amplitude.
  [[nodiscard]] RigidState stateAt(BodyIndex body, double time) noexcept;
  /// Reads the states of all bodies at `time`, by index.
  void readStates(double time, std::vector<RigidState>& states) noexcept;
  /// The earliest kept moment later than `time` [s]; infinity without one.
  [[nodiscard]] double nextKeptAfter(double time) const noexcept {
    return snapshots_.nextAfter(time);
  }
  /// Replaces the body's present state, and each one kept for later than `time`, by `change` of it.
  template <typename Change>
  void changeAfter(double time, BodyIndex body, Change change) noexcept {
    island_.setState(body, change(island_.state(body)));
    changeKeptAfter(time, body, [&](const RigidState& state, double) { return change(state); });
  }
  /// Replaces the body's states kept for later than `time` by `change` of each and its time [s].
  template <typename Change>
  void changeKeptAfter(double time, BodyIndex body, Change change) noexcept {
    snapshots_.forEachAfter(time, [&](std::vector<RigidState>& states, double kept) {
      RigidState& state = states[static_cast<std::size_t>(body)];
      state = change(state, kept);
    });
  }
  /// Adds `offset_W` to all kept positions.
  void shiftOrigin(const Vec3& offset_W) noexcept {
    for (RigidState& state : start_states_) state.p_W += offset_W;
    snapshots_.shiftOrigin(offset_W);
  }
  /// Puts a body elsewhere. Its kept states move along, so that none leads there from its old
  /// place.
  void put(BodyIndex body, const RigidState& state) noexcept;
  /// Gives a body that enters the island the past of one that was always at `state`. Its slot's
  /// kept states are of another body, or of none.
  void enter(BodyIndex body, const RigidState& state) noexcept {
    changeKeptAfter(-kNever, body, [&](const RigidState&, double) { return state; });
    setStart(body, state);
  }
  /// Sets the state of a body at the start of the tick.
  void setStart(BodyIndex body, const RigidState& state) noexcept {
    start_states_[static_cast<std::size_t>(body)] = state;
  }

  /// True if nothing has moved since the tick's start.
  [[nodiscard]] bool sleptSinceStart() const noexcept { return start_rest_.holds(island_); }
  /// Calls `visit(body, its state at the tick's start)` for each body that was awake then.
  template <typename Visit>
  void forEachMoved(Visit visit) const noexcept {
    for (const BodyIndex b : moved_) visit(b, start_states_[static_cast<std::size_t>(b)]);
  }

 private:
  /// Keeps the present states as those of all times from `since` to `time`.
  void keepStates(double since, double time) noexcept;

  Island& island_;
  double period_, host_step_;
  double start_ = 0.0, time_ = 0.0, tick_start_ = 0.0;
  std::uint64_t ticks_ = 0;
  double step_end_;  ///< next announced end of a host step [s]
  Snapshots snapshots_;
  std::vector<RigidState> start_states_;
  std::vector<BodyIndex> moved_;  ///< awake when the latest tick began
  RestMark start_rest_, snapshot_rest_;
};

/// State of a body `dt` before `end`, for steady motion.
[[nodiscard]] RigidState computeStart(RigidState end, double dt) noexcept;

}  // namespace tandem
