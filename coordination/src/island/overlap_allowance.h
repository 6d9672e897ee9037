#pragma once

#include <cstddef>
#include <vector>

#include "island/contact_finder.h"

namespace tandem {

/// Overlap that pairs of bodies may keep. It starts as the overlap at the first sight, which the
/// host left, and only shrinks. Pushing it out would add energy and move bodies at rest.
///
/// Each step calls begin(), look() at each contact and end(), then overlapOf() as needed.
class OverlapAllowance {
 public:
  explicit OverlapAllowance(std::size_t capacity) { pairs_.reserve(capacity); }

  void begin() noexcept;
  /// Notes a contact; it has its distance after the smooth motion, `at_start` that at the start
  /// [m].
  void look(const RigidContact& contact, double at_start) noexcept;
  void end() noexcept;
  /// The overlap that the contact may keep, <= 0 [m].
  [[nodiscard]] double overlapOf(const RigidContact& contact) const noexcept;
  void forget() noexcept { pairs_.clear(); }

 private:
  struct Pair {
    BodyIndex a, b;
    bool is_new, seen;
    double overlap;  ///< <= 0
    double least;    ///< least distance in this step [m]
  };
  [[nodiscard]] const Pair* find(const RigidContact& contact) const noexcept;

  std::vector<Pair> pairs_;
  /// Index of the last pair found; contacts come pair by pair.
  mutable std::size_t hint_ = 0;
};

}  // namespace tandem
