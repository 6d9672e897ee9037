#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "tandem/coordination/link.h"

namespace tandem::view {

/// The last told states of one thing, and where it was between them.
class MotionHistory {
 public:
  /// A gap is bridged over its last part of this length; before that the thing stays [s].
  static constexpr double kLongest = 0.125;
  /// After the newest state it goes on for so long, then it stays [s].
  static constexpr double kFarthest = 1.0 / 16.0;

  /// `time` is the sender's, above all before [s].
  void add(double time, const RigidState& state, const ObjectEpoch& epoch = {});

  /// Forgets all but the newest state, in which the thing has stood until `time` [s].
  void standUntil(double time);

  /// Pose at a time: on a cubic with the told places and velocities, turned evenly. Between two
  /// epochs it jumps. Empty before the first add().
  [[nodiscard]] std::optional<RigidState> at(double time) const;

 private:
  static constexpr std::size_t kKept = 8;

  struct Moment {
    double time = 0.0;
    RigidState state;
    ObjectEpoch epoch;
  };
  [[nodiscard]] const Moment& get(std::size_t at) const { return moments_[at % kKept]; }
  [[nodiscard]] static RigidState between(const Moment& from, const Moment& to, double time);

  std::array<Moment, kKept> moments_;  ///< a ring
  std::size_t begin_ = 0, end_ = 0;    ///< of those in it, counted from the first of all
};

}  // namespace tandem::view
