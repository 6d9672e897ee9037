#pragma once

namespace tandem {

/// Group and mask of a body, as physics engines know them. Two bodies meet if the group of each is
/// in the mask of the other. The defaults meet all bodies that take part in group 1.
struct CollisionFilter {
  int group = 1;
  int mask = -1;

  [[nodiscard]] constexpr bool meets(const CollisionFilter& other) const noexcept {
    return (group & other.mask) != 0 && (other.group & mask) != 0;
  }
  [[nodiscard]] constexpr bool operator==(const CollisionFilter&) const noexcept = default;
};

}  // namespace tandem
