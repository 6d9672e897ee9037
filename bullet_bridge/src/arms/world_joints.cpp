#include "arms/world_joints.h"

namespace tandem {

void WorldJoints::look(const HostJoints::Find& find,
                       const std::vector<ArmJoints::Member>& members) {
  rigid_.look(find);
  arms_.look(members);
  ends_.reserve(2 * kMaxJoints);
}

void WorldJoints::switchOff() noexcept {
  rigid_.switchOff();
  arms_.switchOff();
}

void WorldJoints::switchOn() noexcept {
  rigid_.switchOn();
  arms_.switchOn();
}

void WorldJoints::forgetWorld() noexcept {
  rigid_.forgetWorld();
  arms_.forgetWorld();
}

bool WorldJoints::take() noexcept {
  const bool has_rigid = rigid_.take(), has_arms = arms_.take();
  if (!has_rigid && !has_arms) return false;
  list();
  return true;
}

bool WorldJoints::refresh(const PayWindow& window) noexcept {
  const bool has_rigid = rigid_.refresh(window.dt), has_arms = arms_.refresh(window);
  return has_rigid || has_arms;
}

bool WorldJoints::tell(double dt) noexcept {
  arms_.tell(dt);
  if (!rigid_.tell(dt)) return false;
  list();
  return true;
}

bool WorldJoints::dropGone() noexcept {
  if (!rigid_.dropGone()) return false;
  list();
  return true;
}

void WorldJoints::drop(BodyIndex body) noexcept {
  rigid_.drop(body);
  arms_.drop(body);
  list();
}

/// The island has room for kMaxJoints; those of arms come last.
void WorldJoints::list() noexcept {
  ends_.clear();
  for (const JointEnds& ends : rigid_.joints()) ends_.push_back(ends);
  for (const JointEnds& ends : arms_.joints())
    if (ends_.size() < kMaxJoints) ends_.push_back(ends);
}

void WorldJoints::evaluate(std::size_t joint, const RigidState& a, const RigidState& b,
                           std::vector<JointRow>& rows) noexcept {
  const std::size_t count = rigid_.joints().size();
  if (joint < count) return rigid_.evaluate(joint, a, b, rows);
  arms_.evaluate(joint - count, a, b, rows);
}

void WorldJoints::note(std::size_t joint, const JointRow& row, double impulse, double h,
                       bool is_first) noexcept {
  const std::size_t count = rigid_.joints().size();
  if (joint < count) return rigid_.note(joint, row, impulse, h, is_first);
  arms_.note(joint - count, row, impulse, h, is_first);
}

}  // namespace tandem
