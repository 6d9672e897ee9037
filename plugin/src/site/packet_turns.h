#pragma once

#include <algorithm>
#include <vector>

#include "tandem/coordination/link.h"

namespace tandem {

/// Chooses the shared objects of a packet when not all fit. Objects that moved since they were last
/// sent go first, and the others fill the rest. Both groups take turns. One place is always left to
/// the others, so none waits forever. An object that came to rest while its last packet was lost is
/// also sent again.
class PacketTurns {
 public:
  /// Allocates.
  void setObjectCount(std::size_t count) {
    is_chosen_.resize(count);
    chosen_.reserve(kMaxObjectsPerPacket);
  }

  /// Indices in ascending order, valid until the next call. Real-time safe.
  template <typename HasMoved>
  const std::vector<std::size_t>& choose(HasMoved has_moved) noexcept {
    chosen_.clear();
    std::fill(is_chosen_.begin(), is_chosen_.end(), char{0});
    if (is_chosen_.size() > kMaxObjectsPerPacket)
      take(next_moved_, kMaxObjectsPerPacket - 1, has_moved);
    take(next_, kMaxObjectsPerPacket, [](std::size_t) { return true; });
    std::sort(chosen_.begin(), chosen_.end());
    return chosen_;
  }

 private:
  /// Goes round once from `next`, until `until` objects are chosen. `next` then follows the last
  /// one taken.
  template <typename IsWanted>
  void take(std::size_t& next, std::size_t until, IsWanted is_wanted) noexcept {
    const std::size_t count = is_chosen_.size(), first = next;
    for (std::size_t i = 0; i < count && chosen_.size() < until; ++i) {
      const std::size_t object = (first + i) % count;
      if (is_chosen_[object] || !is_wanted(object)) continue;
      is_chosen_[object] = 1;
      chosen_.push_back(object);
      next = (object + 1) % count;
    }
  }

  std::vector<char> is_chosen_;
  std::vector<std::size_t> chosen_;
  std::size_t next_moved_ = 0, next_ = 0;
};

}  // namespace tandem
