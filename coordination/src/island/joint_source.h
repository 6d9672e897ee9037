#pragma once

#include <cstdint>
#include <vector>

#include "tandem/coordination/types.h"

#include "island/contact_finder.h"

#pragma GCC visibility push(default)
namespace tandem {

/// What a row of a joint does.
enum class JointLaw : std::uint8_t {
  kLocked,  ///< no way along it, whatever the force
  kLimit,   ///< its way stays at or above 0: it pushes, and never pulls
  kMotor,   ///< a force within bounds brings it to a speed
};

/// One way in which a joint holds two bodies at given poses. Its speed is
///
///   u = n . (v_a - v_b) + turn_a . w_a + turn_b . w_b
///
/// and an impulse P along it gives a the momentum n P and the angular momentum turn_a P, and b the
/// momentum -n P and the angular momentum turn_b P. A purely angular row has n = 0.
struct JointRow {
  JointLaw law = JointLaw::kLocked;
  int number = 0;                ///< the same for the same row of the joint, at all poses
  Vec3 n_W = Vec3::Zero();       ///< unit vector or zero
  Vec3 turn_a_W = Vec3::Zero();  ///< arm x n, or an axis [m or 1]
  Vec3 turn_b_W = Vec3::Zero();
  /// Locked: way of a beside b that is off [m or rad]; its rate is u. Limit: way that is left;
  /// below 0 it is past the stop. Motor: unused.
  double way = 0.0;
  /// Rate of u while both ends keep their velocities [m/s^2 or rad/s^2]. Where the row does not
  /// tell it, the island finds it from the row at later poses.
  double bend = 0.0;
  bool tells_bend = false;
  double speed = 0.0;       ///< a motor's wanted u [m/s or rad/s]; else 0
  double speed_rate = 0.0;  ///< its rate, by the way that u goes [m/s^2 or rad/s^2]
  double bounce = 0.0;      ///< restitution of a limit
  /// Of a locked row or a limit: 0 for both makes it rigid. Else its force along the row is
  /// -(stiffness way + damping u) [N/m, N s/m or N m/rad, N m s/rad]; a limit acts while its way
  /// is below 0, and never pulls.
  double stiffness = 0.0, damping = 0.0;
  /// A motor's least and greatest force [N or N m].
  double low = 0.0, high = 0.0;
};

/// Most rows of a joint: six locked or limited ones, six motors, six springs, and some to spare.
/// JointRow::number is below it.
inline constexpr int kMostJointRows = 24;

/// Most joints of an island.
inline constexpr std::size_t kMaxJoints = 128;

/// A joint between two bodies of the island, or of one and a fixed place.
struct JointEnds {
  BodyIndex a = kStanding, b = kStanding;
  const void* id = nullptr;  ///< another joint has another one
};

/// Tells how joints hold bodies of the island.
///
/// The island solves joints; others know their kinds. `bullet_bridge` asks Bullet's own
/// constraints, on private copies. All functions run in the tick: no throw, no allocation after
/// warm-up.
class JointSource {
 public:
  virtual ~JointSource() = default;

  /// The joints that act now, at most kMaxJoints. They change only between advances.
  [[nodiscard]] virtual const std::vector<JointEnds>& joints() const noexcept = 0;
  /// Relative rounding of the rows' directions.
  [[nodiscard]] virtual double rounding() const noexcept = 0;

  /// Adds the rows of a joint at given poses and velocities of its ends, at most kMostJointRows.
  /// The state of a fixed end is unused. Limits that are far may be missing.
  virtual void evaluate(std::size_t joint, const RigidState& a, const RigidState& b,
                        std::vector<JointRow>& rows) noexcept = 0;

  /// A step of `h` [s] is done, in which a row gave a the impulse `impulse` along it [N s, N m s].
  /// All rows of a joint come one after the other, the first of them with `is_first`.
  virtual void note(std::size_t joint, const JointRow& row, double impulse, double h,
                    bool is_first) noexcept = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
