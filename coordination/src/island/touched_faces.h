#pragma once

#include <algorithm>
#include <vector>

#include "island/touch_key.h"

namespace tandem {

/// The faces that spheres touch, from tick to tick. A sphere that goes in leaves through the same
/// face: geometry/held_face.h.
///
/// One tick looks at all touches between startLook() and endLook(); what it did not keep is
/// forgotten.
class TouchedFaces {
 public:
  /// Allocates. Touches beyond `most` are not remembered.
  void makeRoom(std::size_t most) { entries_.reserve(most); }

  [[nodiscard]] bool isEmpty() const noexcept { return entries_.empty(); }
  /// Face of a touch, for a mesh its triangle; -1 if none is remembered.
  [[nodiscard]] int find(const TouchKey& key) const noexcept {
    for (const Entry& entry : entries_)
      if (entry.key == key) return entry.face;
    return -1;
  }

  /// True if a face of any part of a compound is remembered.
  [[nodiscard]] bool holdsPartOf(const TouchKey& whole) const noexcept {
    return std::any_of(entries_.begin(), entries_.end(),
                       [&](const Entry& entry) { return entry.key.isOf(whole); });
  }

  /// Deepest overlap [m].
  [[nodiscard]] double deepest() const noexcept {
    double gap = 0.0;
    for (const Entry& entry : entries_) gap = std::min(gap, entry.gap);
    return -gap;
  }

  void startLook() noexcept {
    for (Entry& entry : entries_) entry.is_kept = false;
  }
  /// Remembers a face, and the gap to it [m], until the next look. False: there is no room.
  bool keep(const TouchKey& key, int face, double gap) noexcept {
    for (Entry& entry : entries_) {
      if (!(entry.key == key)) continue;
      entry = {key, face, gap, true};
      return true;
    }
    if (entries_.size() == entries_.capacity()) return false;
    entries_.push_back({key, face, gap, true});
    return true;
  }
  void endLook() noexcept {
    std::erase_if(entries_, [](const Entry& entry) { return !entry.is_kept; });
  }

  /// Forgets the touches of a body.
  void forget(BodyIndex body) noexcept {
    std::erase_if(entries_, [&](const Entry& entry) {
      return entry.key.sphere == body || entry.key.other == body;
    });
  }
  /// Forgets the touches of an obstacle, by TouchKey::obstacle.
  void forgetObstacle(std::uint64_t obstacle) noexcept {
    std::erase_if(entries_, [&](const Entry& entry) { return entry.key.obstacle == obstacle; });
  }
  /// Forgets a touch.
  void forget(const TouchKey& key) noexcept {
    std::erase_if(entries_, [&](const Entry& entry) { return entry.key == key; });
  }

 private:
  struct Entry {
    TouchKey key;
    int face = -1;
    double gap = 0.0;
    bool is_kept = false;
  };
  std::vector<Entry> entries_;
};

}  // namespace tandem
