#pragma once

#include <vector>

#include "island/contact_factor.h"
#include "island/island_model.h"
#include "island/joint_hold.h"
#include "island/joint_memory.h"
#include "island/joint_source.h"
#include "island/rigid_row.h"

namespace tandem {

/// Forces of joints during smooth motion, as a function of the bodies' state.
///
/// Rows that hold keep their speed. They accelerate the bodies by x = M^-1 J^T f so that
///
///   J (a + x) + J' v = 0
///
/// A motor at a bound pushes with it. The forces f are multipliers, found as ContactSolver finds
/// impulses: closed loops do no harm. RigidStep takes out what errors of integration leave.
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
  };
  [[nodiscard]] const std::vector<Joint>& joints() const noexcept { return joints_; }

 private:
  /// A row with its value a moment later.
  struct Row {
    const Joint* joint;
    JointRow now, later;
  };
  struct Triple {
    std::size_t place[3];  ///< in force_
    double wanted[3] = {}, f[3] = {}, stiffness[3] = {};
    int count = 0;
  };

  [[nodiscard]] static std::size_t place(std::size_t joint, const JointRow& row) noexcept {
    return joint * static_cast<std::size_t>(kMostJointRows) + static_cast<std::size_t>(row.number);
  }
  void orderBodies() noexcept;
  [[nodiscard]] double chooseMoment() const noexcept;
  void gather(double moment) noexcept;
  void push(const Joint& joint, const JointRow& row, double force) noexcept;
  void build(double moment) noexcept;
  void addRow(const Row& row, double wanted, bool is_first) noexcept;
  void iterate() noexcept;

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
  std::vector<JointRow> now_, later_;
  std::vector<Triple> triples_;
  std::vector<ContactJacobian> J_;
  std::vector<ContactStiffness> D_;
  std::vector<int> first_;
  std::vector<Six> x_, dx_;
  std::vector<double> force_;  ///< by place()
  ContactFactor factor_;
};

}  // namespace tandem
