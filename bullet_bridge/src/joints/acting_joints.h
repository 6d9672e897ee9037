#pragma once

#include <algorithm>
#include <vector>

#include "coordination/src/island/joint_source.h"

namespace tandem {

/// Those of a source's joints that have not gone, as the island counts them. A `Joint` has `ends`
/// and `is_gone`. After reserve() all is real-time safe.
class ActingJoints {
 public:
  /// Makes room for all joints that an island may have.
  void reserve() {
    ends_.reserve(kMaxJoints);
    places_.reserve(kMaxJoints);
  }

  template <typename Joint>
  void list(const std::vector<Joint>& joints) noexcept {
    ends_.clear();
    places_.clear();
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (joints[i].is_gone) continue;
      ends_.push_back(joints[i].ends);
      places_.push_back(i);
    }
  }

  /// True if one of them has gone since list().
  template <typename Joint>
  [[nodiscard]] bool hasGone(const std::vector<Joint>& joints) const noexcept {
    return std::any_of(places_.begin(), places_.end(),
                       [&](std::size_t place) { return joints[place].is_gone; });
  }

  /// JointSource::joints() says these.
  [[nodiscard]] const std::vector<JointEnds>& ends() const noexcept { return ends_; }
  /// Places in the source's list, by the island's index.
  [[nodiscard]] const std::vector<std::size_t>& places() const noexcept { return places_; }

 private:
  std::vector<JointEnds> ends_;
  std::vector<std::size_t> places_;
};

/// Marks the joints of a body as gone.
template <typename Joint>
void endJointsOf(BodyIndex body, std::vector<Joint>& joints) noexcept {
  for (Joint& joint : joints) joint.is_gone |= joint.ends.a == body || joint.ends.b == body;
}

/// Turns `told` of a joint to what it has `given` since the last call. False: it never gave
/// anything. A joint at rest goes on with its last forces.
template <typename Joint>
[[nodiscard]] bool turnToGiven(Joint& joint) noexcept {
  if (joint.given.time > 0.0) joint.told = joint.given;
  joint.given = {};
  return joint.told.time > 0.0;
}

}  // namespace tandem
