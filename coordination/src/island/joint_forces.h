#pragma once

#include <vector>

#include "island/island_model.h"
#include "island/joint_hold.h"
#include "island/joint_memory.h"
#include "island/joint_source.h"
#include "island/mass_roots.h"
#include "island/panel_matrix.h"
#include "island/six.h"

namespace tandem {

/// Forces of joints during smooth motion, as a function of the bodies' state.
///
/// Rows that hold keep their speed. They accelerate the bodies by x = M^-1 J^T f so that
///
///   J (a + x) + J' v = 0
///
/// A motor at a bound pushes with it. The matrix J M^-1 J^T of a chain has a narrow envelope. A
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

  /// Whether joints may answer any load. The forces of a jam are no load: joints and contacts would
  /// answer each other.
  void trustLoad(bool trusts) noexcept { trusts_load_ = trusts; }

  /// Force of a row in the last solve() [N, N m].
  [[nodiscard]] double force(std::size_t joint, const JointRow& row) const noexcept {
    return force_[place(joint, row)];
  }
  [[nodiscard]] JointMemory& memory() noexcept { return memory_; }

  struct Joint {
    std::size_t index = 0;  ///< of JointSource
    BodyIndex a = kStanding, b = kStanding;
    std::size_t first = 0;  ///< joint from which on joints in this list may share a body with it
    int block_a = -1, block_b = -1;  ///< block rows of its ends; -1: none
  };
  [[nodiscard]] const std::vector<Joint>& joints() const noexcept { return joints_; }

 private:
  /// A body that joints move.
  struct Mover {
    MassRoots roots;
    double radius_squared = 0.0;
  };
  /// What a row says to its ends in their units: speed per velocity, and motion per impulse.
  struct Direction {
    Six of_a, of_b;
  };
  static constexpr int kPanelRows = 6;
  /// Rows of a joint that hold, at most six.
  struct Panel {
    std::size_t joint = 0;  ///< in joints_
    int count = 0;
    /// Directions by component: its value in each row.
    Six of_a[6], of_b[6];
    Six wanted;                          ///< rates of their speeds that the bodies lack
    double freed[kPanelRows] = {};       ///< RowMobility::freed()
    double bound[kPanelRows] = {};       ///< greatest force; HUGE_VAL: none [N, N m]
    int number[kPanelRows] = {};         ///< JointRow::number
    std::size_t place[kPanelRows] = {};  ///< in force_
  };

  [[nodiscard]] static std::size_t place(std::size_t joint, const JointRow& row) noexcept {
    return joint * static_cast<std::size_t>(kMostJointRows) + static_cast<std::size_t>(row.number);
  }
  void orderBodies() noexcept;
  void orderJoints() noexcept;
  void setUpMovers() noexcept;
  void gather() noexcept;
  void gather(std::size_t joint) noexcept;
  void measureBends(const Joint& joint) noexcept;
  [[nodiscard]] double chooseMoment() const noexcept;
  [[nodiscard]] Direction findDirection(const Joint& joint, const JointRow& row) const noexcept;
  [[nodiscard]] RowMobility mobilityOf(const Joint& joint, const JointRow& row,
                                       const Direction& along) const noexcept;
  void push(const Joint& joint, const Direction& along, double force) noexcept;
  [[nodiscard]] double rateOf(const Joint& joint, const JointRow& row) const noexcept;
  void hold(std::size_t joint, const JointRow& row, const Direction& along, double freed) noexcept;
  [[nodiscard]] bool factorise() noexcept;
  void fillBlock(const Panel& panel, const Panel& other, SixBySix& block) const noexcept;
  [[nodiscard]] double measureMissing() noexcept;
  void addForces() noexcept;
  [[nodiscard]] bool isBelievable() const noexcept;
  [[nodiscard]] bool letGo() noexcept;
  void iterate() noexcept;
  void accelerate() noexcept;
  [[nodiscard]] int blockOf(BodyIndex body) const noexcept {
    return body == kStanding ? -1 : block_of_[static_cast<std::size_t>(body)];
  }
  [[nodiscard]] const RigidState& stateOf(BodyIndex body) const noexcept;

  JointSource* source_ = nullptr;
  const IslandModel* model_ = nullptr;
  JointMemory memory_;
  std::vector<Joint> joints_;
  std::vector<BodyIndex> ends_;
  std::vector<BodyIndex> bodies_;  ///< by block row
  std::vector<int> block_of_;      ///< by body; -1: joints do not move it
  std::vector<char> is_end_, moved_;
  std::vector<End> at_;        ///< by body
  std::vector<Mover> movers_;  ///< by block row
  bool trusts_load_ = true;
  double moment_ = 0.0;  ///< chooseMoment(), once it is needed; below 0: not yet [s]
  std::vector<Panel> panels_;
  std::vector<std::size_t> first_panel_;  ///< by joint of joints_
  std::vector<JointRow> now_, later_;
  PanelMatrix matrix_;
  std::vector<Six> part_;      ///< missing rates, then forces, by panel
  std::vector<Six> x_;         ///< motion by joints, in each body's units, by block row
  std::vector<Six> pushed_;    ///< the part of rows whose force is known
  std::vector<double> force_;  ///< by place()
};

}  // namespace tandem
