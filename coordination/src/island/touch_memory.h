#pragma once

#include <algorithm>
#include <vector>

#include "island/touch_key.h"

namespace tandem {

// clang-format off
/// Overlap that contacts do not push against yet.
///
/// A body that appears inside another one, or is put there, would be shot out by the stiffness of
/// the contact. Such a contact starts with an allowance a of its depth d, and pushes by
///
///     f = [K (d - a) + B d']+        a falls at c = min(0.05 m/s, a(0) / 0.2 s), and never exceeds d
///
/// A free body starts at rest and swings about the speed c of its place of rest. So it leaves at
/// 2 c = 0.1 m/s at most, whatever its mass and the stiffness.
// clang-format on
class TouchMemory {
 public:
  /// An overlap that grew by less than this without motion pushes at once [m]. At 4000 N/m it
  /// throws a body of 20 g at 0.09 m/s.
  static constexpr double kNoticed = 2e-4;
  /// Top speed of a falling allowance [m/s], and its shortest time to zero [s].
  static constexpr double kTopSpeed = 0.05, kShortestTime = 0.2;

  /// Allocates. Contacts beyond `most` get no allowance.
  void makeRoom(std::size_t most) { entries_.reserve(most); }

  [[nodiscard]] bool isEmpty() const noexcept { return entries_.empty(); }
  /// Allowance of a contact for the coming advance, which is that of its middle, or `ahead` of that
  /// [s]; 0 if it has none [m].
  [[nodiscard]] double allowance(const TouchKey& key, double ahead = 0.0) const noexcept;
  /// Keeps the depth [m] of a contact before one of its partners jumps.
  void keepDepth(const TouchKey& key, double depth) noexcept;
  /// Turns the growth of the depth since keepDepth() into allowance if it exceeds `noticed` [m].
  /// Without keepDepth() the contact is new. A second call at the same depth changes nothing.
  void letIn(const TouchKey& key, double depth, double noticed = kNoticed) noexcept;
  void clear() noexcept { entries_.clear(); }
  /// Forgets the contacts of a body.
  void forget(BodyIndex body) noexcept;

  /// Lets the allowances fall for `dt` [s]. `measure(key)` returns a contact's present depth [m].
  template <typename Measure>
  void age(double dt, Measure measure) noexcept {
    for (Entry& entry : entries_)
      entry.allowance = std::min(entry.allowance - entry.speed * dt, measure(entry.key));
    std::erase_if(entries_, [](const Entry& entry) { return !(entry.allowance > 0.0); });
  }

 private:
  struct Entry {
    TouchKey key;
    double depth = 0.0;      ///< before the latest jump [m]
    double allowance = 0.0;  ///< [m]
    double speed = 0.0;      ///< of the allowance's fall [m/s]
  };
  [[nodiscard]] Entry* findOrAdd(const TouchKey& key) noexcept;

  std::vector<Entry> entries_;
};

}  // namespace tandem
