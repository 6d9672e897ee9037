#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "island/joint_source.h"

namespace tandem {

/// What a row of a joint does over a step.
enum class JointMode : std::uint8_t {
  kIdle,   ///< no force: a limit that is not reached
  kHolds,  ///< whatever force keeps its speed
  kLow,    ///< a motor at its least force
  kHigh,   ///< a motor at its greatest force
};

/// Modes of the rows of all joints in the last step, and in tries of the next. Real-time safe.
class JointMemory {
 public:
  /// Allocates.
  explicit JointMemory(std::size_t max_joints) {
    known_.reserve(max_joints);
    trial_.reserve(max_joints);
    marked_.reserve(max_joints);
  }

  void forget() noexcept {
    known_.clear();
    trial_.clear();
  }
  /// Before an advance: joints that are not those of the last one begin anew.
  void follow(const std::vector<JointEnds>& joints) noexcept {
    known_.resize(joints.size());
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (known_[i].id == joints[i].id) continue;
      known_[i] = {};
      known_[i].id = joints[i].id;
    }
    trial_ = marked_ = known_;
  }
  /// The advance begins anew: what it has seen has not been.
  void goBack() noexcept { trial_ = known_ = marked_; }

  /// Mode of a row in the present try.
  [[nodiscard]] JointMode mode(std::size_t joint, const JointRow& row) const noexcept {
    if (row.law == JointLaw::kLocked) return JointMode::kHolds;
    if (row.law == JointLaw::kMotor && row.low == row.high) return JointMode::kLow;
    const Modes& modes = trial_[joint];
    const auto place = static_cast<std::size_t>(row.number);
    if (modes.is_known[place]) return modes.at[place];
    return row.law == JointLaw::kLimit ? JointMode::kIdle : JointMode::kHolds;
  }
  /// `number`: JointRow::number
  void setMode(std::size_t joint, int number, JointMode mode) noexcept {
    Modes& modes = trial_[joint];
    const auto place = static_cast<std::size_t>(number);
    modes.at[place] = mode;
    modes.is_known[place] = true;
  }

  /// The step is repeated with another length.
  void startAgain() noexcept { trial_ = known_; }
  /// The step is done.
  void keep() noexcept { known_ = trial_; }

 private:
  struct Modes {
    const void* id = nullptr;
    std::array<JointMode, kMostJointRows> at = {};
    std::array<bool, kMostJointRows> is_known = {};
  };
  std::vector<Modes> known_, trial_;
  std::vector<Modes> marked_;  ///< before the present advance
};

}  // namespace tandem
