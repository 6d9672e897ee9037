#pragma once

#include <vector>

#include "island/island_model.h"
#include "island/joint_hold.h"
#include "island/joint_memory.h"
#include "island/joint_source.h"
#include "island/rigid_row.h"
#include "island/six.h"
#include "island/skyline_matrix.h"

namespace tandem {

/// Forces of joints during smooth motion, as a function of the bodies' state.
///
/// Rows that hold keep their speed. They accelerate the bodies by x = M^-1 J^T f so that
///
///   J (a + x) + J' v = 0
///
/// A motor at a bound pushes with it. The matrix J M^-1 J^T of a chain has a narrow skyline. A
/// trace of compliance keeps rows that say the same, as in closed loops, from making it singular.
/// RigidStep takes out what errors of integration leave.
class JointForces {
 public:
  /// An end of a joint during an evaluation.
  struct End {
    RigidState state;
    Vec3 a_W = Vec3::Zero(), alpha_W = Vec3::Zero();
  };

  /// Allocates.
  JointForces(std::size_t body_count, std::size_t max_joints);

  /// Selects the joints with an end among the `moved` bodies. Real-time safe, as all below.
  void choose(const IslandModel& model, const std::vector<char>& moved) noexcept;
  [[nodiscard]] bool isEmpty() const noexcept { return joints_.empty(); }
  /// Both ends of all joints, each once.
  [[nodiscard]] const std::vector<BodyIndex>& ends() const noexcept { return ends_; }
  [[nodiscard]] bool isEnd(BodyIndex body) const noexcept {
    return is_end_[static_cast<std::size_t>(body)];
  }
  [[nodiscard]] bool moves(BodyIndex body) const noexcept {
    return block_of_[static_cast<std::size_t>(body)] >= 0;
  }
  /// State and acceleration without joints; to be set for all ends() before solve(), which adds
  /// the joints' part.
  [[nodiscard]] End& end(BodyIndex body) noexcept { return at_[static_cast<std::size_t>(body)]; }
  void solve() noexcept;

  /// Force of a row in the last solve() [N, N m].
  [[nodiscard]] double force(std::size_t joint, const JointRow& row) const noexcept {
    return force_[place(joint, row)];
  }
  [[nodiscard]] JointMemory& memory() noexcept { return memory_; }

  struct Joint {
    std::size_t index;  ///< of JointSource
    BodyIndex a, b;
    std::size_t first;  ///< joint from which on joints in this list may share a body with it
  };
  [[nodiscard]] const std::vector<Joint>& joints() const noexcept { return joints_; }

 private:
  /// A row that holds.
  struct Row {
    std::size_t place = 0;           ///< in force_
    int block_a = -1, block_b = -1;  ///< -1: none
    PlainVec n, turn_a, turn_b;      ///< JointRow
    Six of_a, of_b;                  ///< the same in units in which each body has mass 1
    double wanted = 0.0;             ///< rate of its speed that the bodies lack
  };

  [[nodiscard]] static std::size_t place(std::size_t joint, const JointRow& row) noexcept {
    return joint * static_cast<std::size_t>(kMostJointRows) + static_cast<std::size_t>(row.number);
  }
  void orderBodies() noexcept;
  void orderJoints() noexcept;
  [[nodiscard]] double chooseMoment() const noexcept;
  void gather(double moment) noexcept;
  [[nodiscard]] double mobilityOf(const Joint& joint, const JointRow& row) const noexcept;
  void push(const Joint& joint, const JointRow& row, double force) noexcept;
  void addRow(const Joint& joint, const JointRow& now, const JointRow* later,
              double moment) noexcept;
  void lookAtAccelerations() noexcept;
  [[nodiscard]] bool factorise() noexcept;
  [[nodiscard]] bool isBelievable() const noexcept;
  void iterate() noexcept;
  [[nodiscard]] int blockOf(BodyIndex body) const noexcept {
    return body == kStanding ? -1 : block_of_[static_cast<std::size_t>(body)];
  }

  JointSource* source_ = nullptr;
  const IslandModel* model_ = nullptr;
  JointMemory memory_;
  std::vector<Joint> joints_;
  std::vector<BodyIndex> ends_;
  std::vector<BodyIndex> bodies_;  ///< by block row
  std::vector<int> block_of_;      ///< by body; -1: joints do not move it
  std::vector<char> is_end_, moved_;
  std::vector<End> at_;             ///< by body
  std::vector<RigidMover> movers_;  ///< by block row
  std::vector<Row> rows_;
  std::vector<std::size_t> first_row_;  ///< by joint of joints_
  std::vector<JointRow> now_, later_;
  SkylineMatrix matrix_;
  std::vector<double> part_;   ///< of the forces, by row
  std::vector<Six> x_;         ///< by block row
  std::vector<double> force_;  ///< by place()
};

}  // namespace tandem
