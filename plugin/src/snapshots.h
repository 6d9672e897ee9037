#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tandem/coordination/types.h"

namespace tandem {

/// States of all island bodies at the moments where a host step ends: a tick may straddle such a
/// moment, and then the island has gone on when Bullet asks. Keeps the last few; fixed size once
/// bodies are known.
class Snapshots {
 public:
  void setBodyCount(std::size_t count) {
    for (Snapshot& s : ring_) s.states.resize(count);
  }

  /// Room for the states at `time` [s]; overwrites the oldest.
  std::vector<RigidState>& add(double time) noexcept {
    next_ = (next_ + 1) % ring_.size();
    ring_[next_].time = time;
    return ring_[next_].states;
  }

  /// The newest states within `tolerance` [s] of `time`, or null.
  [[nodiscard]] std::vector<RigidState>* find(double time, double tolerance) noexcept {
    for (std::size_t back = 0; back < ring_.size(); ++back) {
      Snapshot& s = ring_[(next_ + ring_.size() - back) % ring_.size()];
      if (std::abs(s.time - time) <= tolerance) return &s.states;
    }
    return nullptr;
  }

 private:
  struct Snapshot {
    double time = -1e300;
    std::vector<RigidState> states;
  };
  std::array<Snapshot, 8> ring_;
  std::size_t next_ = 0;
};

}  // namespace tandem
