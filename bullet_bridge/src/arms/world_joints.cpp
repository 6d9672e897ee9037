#include "arms/world_joints.h"

namespace tandem {

void WorldJoints::look(const HostJoints::Find& find,
                       const std::vector<ArmJoints::Member>& members) {
  rigid_.look(find);
  arms_.look(members);
  constraints_.look(find, members);
  ends_.reserve(kMaxJoints);
}

void WorldJoints::switchOff() noexcept {
  rigid_.switchOff();
  arms_.switchOff();
  constraints_.switchOff();
}

void WorldJoints::switchOn() noexcept {
  rigid_.switchOn();
  arms_.switchOn();
  constraints_.switchOn();
}

void WorldJoints::forgetWorld() noexcept {
  rigid_.forgetWorld();
  arms_.forgetWorld();
  constraints_.forgetWorld();
}

bool WorldJoints::take() noexcept {
  const bool has_rigid = rigid_.take(), has_arms = arms_.take();
  const bool has_constraints = constraints_.take();
  if (!has_rigid && !has_arms && !has_constraints) return false;
  list();
  return true;
}

bool WorldJoints::refresh(const PayWindow& window) noexcept {
  const bool has_rigid = rigid_.refresh(window.dt), has_arms = arms_.refresh(window);
  const bool has_constraints = constraints_.refresh(window.dt);
  return has_rigid || has_arms || has_constraints;
}

bool WorldJoints::tell(double dt) noexcept {
  arms_.tell(dt);
  constraints_.tell(dt);
  if (!rigid_.tell(dt)) return false;
  list();
  return true;
}

bool WorldJoints::dropGone() noexcept {
  const bool has_rigid = rigid_.dropGone(), has_constraints = constraints_.dropGone();
  if (!has_rigid && !has_constraints) return false;
  list();
  return true;
}

void WorldJoints::drop(BodyIndex body) noexcept {
  rigid_.drop(body);
  arms_.drop(body);
  constraints_.drop(body);
  list();
}

/// The island has room for kMaxJoints; the last ones may be left out.
void WorldJoints::list() noexcept {
  ends_.clear();
  for (const JointSource* source :
       {static_cast<const JointSource*>(&rigid_), static_cast<const JointSource*>(&arms_),
        static_cast<const JointSource*>(&constraints_)})
    for (const JointEnds& ends : source->joints())
      if (ends_.size() < kMaxJoints) ends_.push_back(ends);
}

template <typename Visit>
void WorldJoints::visit(std::size_t joint, Visit visit) noexcept {
  for (JointSource* source : {static_cast<JointSource*>(&rigid_), static_cast<JointSource*>(&arms_),
                              static_cast<JointSource*>(&constraints_)}) {
    const std::size_t count = source->joints().size();
    if (joint < count) return visit(*source, joint);
    joint -= count;
  }
}

void WorldJoints::evaluate(std::size_t joint, const RigidState& a, const RigidState& b,
                           std::vector<JointRow>& rows) noexcept {
  visit(joint, [&](JointSource& source, std::size_t own) { source.evaluate(own, a, b, rows); });
}

void WorldJoints::note(std::size_t joint, const JointRow& row, double impulse, double h,
                       bool is_first) noexcept {
  visit(joint,
        [&](JointSource& source, std::size_t own) { source.note(own, row, impulse, h, is_first); });
}

}  // namespace tandem
