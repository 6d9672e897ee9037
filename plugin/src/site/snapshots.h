#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tandem/coordination/types.h"

namespace tandem {

/// States of all island bodies at the ends of host steps. Such a moment may lie inside a tick, and
/// a late host asks for it long after. Keeps as many of the latest moments as there is room for.
/// Moments of an island at rest share one copy. A moment after lost time is that of all of it.
class Snapshots {
 public:
  Snapshots() : ring_(8) {}

  /// May allocate.
  void setBodyCount(std::size_t count) {
    rest_states_.resize(count);
    for (Snapshot& s : ring_) s.states.resize(count);
  }

  /// Makes room for at least this many moments and keeps the present ones. May allocate.
  void makeRoom(std::size_t moments) {
    if (moments <= ring_.size()) return;
    std::rotate(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(newest_) + 1,
                ring_.end());
    Snapshot empty;
    empty.states.resize(rest_states_.size());
    ring_.insert(ring_.begin(), moments - ring_.size(), empty);
    newest_ = ring_.size() - 1;
  }

  /// Number of moments that fit.
  [[nodiscard]] std::size_t room() const noexcept { return ring_.size(); }

  /// Returns the vector to fill with the states at `time` [s]; overwrites the oldest.
  std::vector<RigidState>& add(double time) noexcept { return add(time, time); }
  /// The same for states that have stood since the time `since` [s].
  std::vector<RigidState>& add(double time, double since) noexcept {
    Snapshot& s = next(time, since);
    s.is_rest = false;
    return s.states;
  }

  /// Returns the vector to fill with the states of an island that has come to rest.
  std::vector<RigidState>& startRest() noexcept {
    for (Snapshot& s : ring_) giveOwnStates(s);
    return rest_states_;
  }

  /// Adds the states of the latest rest as those at `time` [s].
  void addRest(double time) noexcept { next(time, time).is_rest = true; }

  /// The earliest kept moment later than `time` [s]; infinity if there is none.
  [[nodiscard]] double nextAfter(double time) const noexcept {
    double next = std::numeric_limits<double>::infinity();
    for (const Snapshot& s : ring_)
      if (s.time > time) next = std::min(next, s.time);
    return next;
  }

  /// The newest states within `tolerance` [s] of `time`, or null.
  [[nodiscard]] std::vector<RigidState>* find(double time, double tolerance) noexcept {
    for (std::size_t back = 0; back < ring_.size(); ++back) {
      Snapshot& s = ring_[(newest_ + ring_.size() - back) % ring_.size()];
      if (std::abs(s.time - time) > tolerance) continue;
      giveOwnStates(s);
      return &s.states;
    }
    return nullptr;
  }

  /// A kept moment; `states` is null if there is none. They stood from `since` to `time`.
  struct Moment {
    double time = 0.0, since = 0.0;
    const std::vector<RigidState>* states = nullptr;
  };
  /// The latest kept moment up to `time`, and the earliest one after it.
  [[nodiscard]] Moment latestUntil(double time) noexcept {
    return pick([&](double t) { return t <= time; }, [](double t, double u) { return t > u; });
  }
  [[nodiscard]] Moment earliestAfter(double time) noexcept {
    return pick([&](double t) { return t > time; }, [](double t, double u) { return t < u; });
  }

  /// Adds `offset_W` to all positions.
  void shiftOrigin(const Vec3& offset_W) noexcept {
    for (Snapshot& s : ring_)
      for (RigidState& state : s.states) state.p_W += offset_W;
    for (RigidState& state : rest_states_) state.p_W += offset_W;
  }

  /// Calls `visit` with the states and the time of each moment later than `time`.
  template <typename Visit>
  void forEachAfter(double time, Visit visit) noexcept {
    for (Snapshot& s : ring_) {
      if (!(s.time > time)) continue;
      giveOwnStates(s);
      visit(s.states, s.time);
    }
  }

 private:
  static constexpr double kNeverKept = -1e300;
  struct Snapshot {
    double time = kNeverKept, since = kNeverKept;
    bool is_rest = false;
    std::vector<RigidState> states;
  };

  template <typename Counts, typename Better>
  Moment pick(Counts counts, Better better) noexcept {
    Snapshot* best = nullptr;
    for (Snapshot& s : ring_)
      if (s.time > kNeverKept && counts(s.time) && (!best || better(s.time, best->time))) best = &s;
    if (!best) return {};
    giveOwnStates(*best);
    return {best->time, best->since, &best->states};
  }

  Snapshot& next(double time, double since) noexcept {
    newest_ = (newest_ + 1) % ring_.size();
    ring_[newest_].time = time;
    ring_[newest_].since = since;
    return ring_[newest_];
  }

  void giveOwnStates(Snapshot& s) noexcept {
    if (s.is_rest) std::copy(rest_states_.begin(), rest_states_.end(), s.states.begin());
    s.is_rest = false;
  }

  std::vector<Snapshot> ring_;
  std::vector<RigidState> rest_states_;
  std::size_t newest_ = 0;
};

}  // namespace tandem
