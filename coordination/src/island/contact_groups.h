#pragma once

#include <cstddef>
#include <vector>

#include "island/contact_memory.h"
#include "island/joint_hold.h"
#include "island/rigid_row.h"

namespace tandem {

/// Sets of touching and joined bodies with the rows between them. One set may settle while another
/// moves.
class ContactGroups {
 public:
  struct Group {
    RigidRow* const* rows;
    std::size_t row_count;
    RigidMover* const* movers;
    std::size_t mover_count;
    JointHold* const* holds;
    std::size_t hold_count;
  };

  /// Allocates.
  ContactGroups(std::size_t body_count, std::size_t contact_capacity, std::size_t hold_capacity);

  /// Groups the joints, and the points for which `counts(point)` is true. `movers` are by body.
  /// Real-time safe.
  template <typename Counts>
  void make(std::vector<ContactPoint>& points, std::vector<JointHold>& holds,
            std::vector<RigidMover>& movers, Counts counts) noexcept {
    chosen_.clear();
    for (ContactPoint& point : points)
      if (counts(point)) chosen_.push_back(&point);
    chosen_holds_.clear();
    for (JointHold& hold : holds) chosen_holds_.push_back(&hold);
    if (!areAsBefore()) group(movers);
  }

  [[nodiscard]] const std::vector<Group>& groups() const noexcept { return groups_; }

 private:
  /// A row in its place between two bodies: what groups depend on.
  struct Tie {
    const void* row;
    BodyIndex a, b;

    bool operator==(const Tie&) const noexcept = default;
  };

  /// True if the rows have the places and the bodies of the last call, as while contact lasts.
  [[nodiscard]] bool areAsBefore() noexcept;
  void group(std::vector<RigidMover>& movers) noexcept;
  [[nodiscard]] BodyIndex findRoot(BodyIndex body) noexcept;

  std::vector<ContactPoint*> chosen_;
  std::vector<JointHold*> chosen_holds_;
  std::vector<Tie> ties_, ties_before_;
  std::vector<BodyIndex> parent_;  ///< by body: another body of its group, or itself
  std::vector<int> group_of_;      ///< by lowest body of a group: its index; -1: none yet
  std::vector<std::size_t> first_row_, first_mover_, first_hold_;  ///< by group
  std::vector<RigidRow*> rows_;                                    ///< group by group
  std::vector<RigidMover*> movers_;                                ///< group by group
  std::vector<JointHold*> holds_;                                  ///< group by group
  std::vector<Group> groups_;
};

}  // namespace tandem
