#pragma once

#include <cstddef>
#include <vector>

#include "arms/arm_model.h"
#include "coordination/src/island/joint_source.h"

class btRigidBody;

namespace tandem {

class HostArm;

/// An end of a constraint as the host's world has it: a link, or a rigid body that forces move; or
/// none of both, which stands.
struct HeldEnd {
  const HostArm* arm = nullptr;
  std::size_t place = 0;  ///< of the link
  const btRigidBody* rigid = nullptr;
};

/// Finds which rows of constraints say nothing new beside others, among the ways that the joints of
/// multi-bodies leave free.
///
/// A pin that closes a planar loop holds what the joints of its links hold, too. Rows that say the
/// same contradict each other as soon as a constraint is open, and pull as much as their bounds
/// allow. In coordinates of joints, J, such rows are found exactly:
///
///   e_i: rows before, with e_i M^-1 e_j = 1 or 0;   r = J - sum (J M^-1 e_i) e_i;   new: r is not
///   0
///
/// M^-1 is the mobility of multi-bodies and rigid bodies. Of what is open beside each other only a
/// part can be closed: the nearest to all ways, by least squares.
/// After reserve() all is real-time safe.
class HeldRows {
 public:
  /// Makes room for so many constraints of these multi-bodies and rigid bodies.
  void reserve(std::size_t constraints, const std::vector<const HostArm*>& arms,
               const std::vector<const btRigidBody*>& bodies);
  /// Forgets all rows. Those to come are where the host's world is.
  void begin() noexcept;
  /// Adds a row whose force is at most `force` [N or N m].
  void add(const JointRow& row, double force, const HeldEnd& a, const HeldEnd& b) noexcept;
  /// Compares all rows. Rows with greater forces go first, then those that move more.
  void compare() noexcept;

  /// @name Of a row, in the order of add().
  /// @{
  /// True if others hold it, or it cannot move.
  [[nodiscard]] bool isHeld(std::size_t row) const noexcept { return !rows_[row].is_new; }
  /// Its greatest force, but no more than motions ask for [N or N m].
  [[nodiscard]] double greatestForce(std::size_t row) const noexcept { return rows_[row].force; }
  /// What stays open of its way [m or rad].
  [[nodiscard]] double openWay(std::size_t row) const noexcept { return rows_[row].open; }
  /// @}

 private:
  struct Arm {
    const HostArm* arm;
    std::size_t first, count;  ///< of its degrees of freedom
    /// Velocities of all links, one degree of freedom after the other, each at unit velocity.
    std::vector<RigidState> unit;
    ArmCoordinates at;
    std::vector<RigidState> links;  ///< working memory
    bool is_seen = false;           ///< it has rows since begin(); else it may be gone
  };
  struct Body {
    const btRigidBody* body;
    std::size_t first;
    bool is_seen = false;
  };

  struct Row {
    double force = 0.0, way = 0.0, open = 0.0;
    double weight = 1.0;                ///< of its way beside others, and of its mobility
    double mobility = 0.0, rest = 0.0;  ///< rest: without what chosen rows hold
    bool is_new = false, is_done = false;
  };

  static void lookAt(Arm& arm) noexcept;
  void addEnd(const HeldEnd& end, const Vec3& n_W, const Vec3& turn_W, double* along) noexcept;
  void multiplyByMobility(const double* along, double* mobile) const noexcept;
  [[nodiscard]] double dot(const double* one, const double* other) const noexcept;
  [[nodiscard]] Row* chooseNext() noexcept;
  void hold(Row& row) noexcept;
  void findOpenWays() noexcept;
  [[nodiscard]] bool solveReachable() noexcept;
  double* along(std::size_t row) noexcept { return along_.data() + row * dofs_; }
  double* held(std::size_t i) noexcept { return held_.data() + i * dofs_; }
  double* moved(std::size_t i) noexcept { return moved_.data() + i * dofs_; }

  std::vector<Arm> arms_;
  std::vector<Body> bodies_;
  std::size_t dofs_ = 0, count_ = 0;  ///< count_: of e
  std::vector<Row> rows_;
  std::vector<double> along_;         ///< J, row by row
  std::vector<double> held_, moved_;  ///< e and M^-1 e, row by row
  std::vector<double> normal_, reachable_;
};

}  // namespace tandem
