#include "island/contact_groups.h"

#include <algorithm>

namespace tandem {

ContactGroups::ContactGroups(std::size_t body_count, std::size_t contact_capacity,
                             std::size_t hold_capacity)
    : parent_(body_count), group_of_(body_count) {
  chosen_.reserve(contact_capacity);
  rows_.reserve(contact_capacity);
  chosen_holds_.reserve(hold_capacity);
  for (auto* ties : {&ties_, &ties_before_}) ties->reserve(contact_capacity + hold_capacity);
  holds_.reserve(hold_capacity);
  for (auto* places : {&first_row_, &first_mover_, &first_hold_}) places->reserve(body_count);
  movers_.reserve(body_count);
  groups_.reserve(body_count);
}

bool ContactGroups::areAsBefore() noexcept {
  ties_.clear();
  for (const ContactPoint* point : chosen_)
    ties_.push_back({point, point->contact.a, point->contact.b});
  for (const JointHold* hold : chosen_holds_) ties_.push_back({hold, hold->body_a, hold->body_b});
  ties_.swap(ties_before_);
  return ties_ == ties_before_;
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
  const auto join = [&](BodyIndex one, BodyIndex other) {
    if (one == kStanding || other == kStanding) return;
    const BodyIndex a = findRoot(one), b = findRoot(other);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  };
  const auto bodyOf = [](const JointHold& hold) {
    return hold.body_a == kStanding ? hold.body_b : hold.body_a;
  };
  for (const ContactPoint* point : chosen_) join(point->contact.a, point->contact.b);
  for (const JointHold* hold : chosen_holds_) join(hold->body_a, hold->body_b);
  groups_.clear();
  std::fill(group_of_.begin(), group_of_.end(), -1);
  const auto placeOf = [&](BodyIndex body) {
    int& place = group_of_[static_cast<std::size_t>(findRoot(body))];
    if (place < 0) {
      place = static_cast<int>(groups_.size());
      groups_.push_back({nullptr, 0, nullptr, 0, nullptr, 0});
    }
    return static_cast<std::size_t>(place);
  };
  for (RigidMover& mover : movers) mover.place = -1;
  const auto countMover = [&](BodyIndex body) {
    if (body == kStanding || movers[static_cast<std::size_t>(body)].place == 0) return;
    movers[static_cast<std::size_t>(body)].place = 0;
    ++groups_[placeOf(body)].mover_count;
  };
  for (const ContactPoint* point : chosen_) {
    ++groups_[placeOf(point->contact.a)].row_count;
    countMover(point->contact.a);
    countMover(point->contact.b);
  }
  for (const JointHold* hold : chosen_holds_) {
    ++groups_[placeOf(bodyOf(*hold))].hold_count;
    countMover(hold->body_a);
    countMover(hold->body_b);
  }
  for (auto* places : {&first_row_, &first_mover_, &first_hold_}) places->clear();
  std::size_t row = 0, mover = 0, hold = 0;
  for (Group& group : groups_) {
    first_row_.push_back(row);
    first_mover_.push_back(mover);
    first_hold_.push_back(hold);
    row += group.row_count;
    mover += group.mover_count;
    hold += group.hold_count;
    group.row_count = group.mover_count = group.hold_count = 0;
  }
  rows_.resize(row);
  movers_.resize(mover);
  holds_.resize(hold);
  for (ContactPoint* point : chosen_) {
    const std::size_t g = placeOf(point->contact.a);
    rows_[first_row_[g] + groups_[g].row_count++] = &point->row;
  }
  for (JointHold* chosen : chosen_holds_) {
    const std::size_t g = placeOf(bodyOf(*chosen));
    holds_[first_hold_[g] + groups_[g].hold_count++] = chosen;
  }
  for (std::size_t b = 0; b < movers.size(); ++b) {
    if (movers[b].place != 0) continue;
    const std::size_t g = placeOf(static_cast<BodyIndex>(b));
    movers_[first_mover_[g] + groups_[g].mover_count++] = &movers[b];
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].rows = rows_.data() + first_row_[g];
    groups_[g].movers = movers_.data() + first_mover_[g];
    groups_[g].holds = holds_.data() + first_hold_[g];
  }
}

}  // namespace tandem
