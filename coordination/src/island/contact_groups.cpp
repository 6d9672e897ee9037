#include "island/contact_groups.h"

#include <algorithm>

namespace tandem {

ContactGroups::ContactGroups(std::size_t body_count, std::size_t contact_capacity)
    : parent_(body_count), group_of_(body_count) {
  chosen_.reserve(contact_capacity);
  rows_.reserve(contact_capacity);
  for (auto* places : {&first_row_, &first_mover_}) places->reserve(body_count);
  movers_.reserve(body_count);
  groups_.reserve(body_count);
}

/// The lowest body of the group of `body`.
BodyIndex ContactGroups::findRoot(BodyIndex body) noexcept {
  BodyIndex root = parent_[static_cast<std::size_t>(body)];
  while (parent_[static_cast<std::size_t>(root)] != root)
    root = parent_[static_cast<std::size_t>(root)];
  return parent_[static_cast<std::size_t>(body)] = root;
}

void ContactGroups::group(std::vector<RigidMover>& movers) noexcept {
  for (std::size_t b = 0; b < parent_.size(); ++b) parent_[b] = static_cast<BodyIndex>(b);
  for (const ContactPoint* point : chosen_) {
    if (point->contact.b == kStanding) continue;
    const BodyIndex a = findRoot(point->contact.a), b = findRoot(point->contact.b);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  groups_.clear();
  std::fill(group_of_.begin(), group_of_.end(), -1);
  const auto groupOf = [&](BodyIndex body) -> Group& {
    int& place = group_of_[static_cast<std::size_t>(findRoot(body))];
    if (place < 0) {
      place = static_cast<int>(groups_.size());
      groups_.push_back({nullptr, 0, nullptr, 0});
    }
    return groups_[static_cast<std::size_t>(place)];
  };
  for (RigidMover& mover : movers) mover.place = -1;
  const auto countMover = [&](BodyIndex body) {
    if (body == kStanding || movers[static_cast<std::size_t>(body)].place == 0) return;
    movers[static_cast<std::size_t>(body)].place = 0;
    ++groupOf(body).mover_count;
  };
  for (const ContactPoint* point : chosen_) {
    ++groupOf(point->contact.a).row_count;
    countMover(point->contact.a);
    countMover(point->contact.b);
  }
  first_row_.clear();
  first_mover_.clear();
  std::size_t row = 0, mover = 0;
  for (Group& group : groups_) {
    first_row_.push_back(row);
    first_mover_.push_back(mover);
    row += group.row_count;
    mover += group.mover_count;
    group.row_count = group.mover_count = 0;
  }
  rows_.resize(row);
  movers_.resize(mover);
  for (ContactPoint* point : chosen_) {
    Group& group = groupOf(point->contact.a);
    rows_[first_row_[static_cast<std::size_t>(&group - groups_.data())] + group.row_count++] =
        &point->row;
  }
  for (std::size_t b = 0; b < movers.size(); ++b) {
    if (movers[b].place != 0) continue;
    Group& group = groupOf(static_cast<BodyIndex>(b));
    movers_[first_mover_[static_cast<std::size_t>(&group - groups_.data())] + group.mover_count++] =
        &movers[b];
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].rows = rows_.data() + first_row_[g];
    groups_[g].movers = movers_.data() + first_mover_[g];
  }
}

}  // namespace tandem
