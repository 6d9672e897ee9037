#pragma once

#include <cstddef>
#include <vector>

#include "island/contact_finder.h"

namespace tandem {

/// Overlap that pairs may keep: what they had when they were first seen - the host's - and less
/// from then on. Pushed out it would gain energy, and move what rested.
///
/// A step: begin(), look() at each contact, end(), then overlapOf() each.
class OverlapAllowance {
 public:
  explicit OverlapAllowance(std::size_t capacity) { pairs_.reserve(capacity); }

  void begin() noexcept;
  /// A contact's distance at the end of the step's smooth motion, and as it was at its start [m].
  void look(const RigidContact& contact, double at_start) noexcept;
  void end() noexcept;
  /// At most 0 [m].
  [[nodiscard]] double overlapOf(const RigidContact& contact) const noexcept;
  void forget() noexcept { pairs_.clear(); }

 private:
  struct Pair {
    BodyIndex a, b;
    bool is_new, seen;
    double overlap;  ///< <= 0
    double least;    ///< of this step
  };
  [[nodiscard]] const Pair* find(const RigidContact& contact) const noexcept;

  std::vector<Pair> pairs_;
  /// Contacts come pair by pair: where the last one was found.
  mutable std::size_t hint_ = 0;
};

}  // namespace tandem
