#pragma once

#include <memory>
#include <vector>

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "coordination/src/island/contact_finder.h"
#include "native/support_line.h"

#pragma GCC visibility push(default)
namespace tandem {

// clang-format off
/// Contacts of the island that Bullet's solver sees for one step of the host.
///
///     stranger    a moving object that the island does not hold, such as a robot's link
///        |        Bullet's contact
///     body        of the island
///        |        the island's contact, and rows here
///     support     a standing object, or another body of the island
///
/// Without rows, Bullet takes the pressed body for free, and the press sinks in. A row resists only
/// what changes the motion that was handed off:
///
///     n . (dv_a - dv_b) >= -gap / dt,     impulse >= 0
///
/// So it gives nothing where nothing presses. A support that its host leads yields to a press that
/// Bullet's own contact would not hold up: else what it jams is pushed with no end. Meanwhile
/// Bullet's solver makes five times as many sweeps: it forgets the impulses of rows between steps.
/// For the thread that steps the host's world, which sees the rows only in callbacks within its
/// step.
// clang-format on
class SupportRows {
 public:
  explicit SupportRows(btDiscreteDynamicsWorld& host);
  /// Takes rows out of the world, which must exist if it has them.
  ~SupportRows();
  SupportRows(const SupportRows&) = delete;
  SupportRows& operator=(const SupportRows&) = delete;

  /// Pre-tick, before addFace(). The last step becomes the one before.
  void clear() noexcept;
  /// Pre-tick, after the bodies were handed off for a step of `dt` [s]. Adds rows for contacts of
  /// one face at the end of the step. Allocates.
  void addFace(const RigidContact* contacts, std::size_t count, const SupportBody& a,
               const SupportBody& b, double dt);
  /// Post-tick. Takes the rows out of the world.
  void takeOut() noexcept;
  /// Post-tick, when the changes of all bodies are known. Bullet's sweeps leave an error in them,
  /// and know no friction here. This solves both to their end, and corrects the changes. Bodies of
  /// joints get no friction here: the island rubs them by what lasts.
  void finish(double dt) noexcept;
  /// Momentum that the supports gave to a body in the step that has ended. `lasting`: the part that
  /// they gave in the step before, too; of two bodies at a contact both have as much.
  struct Given {
    Momentum all, lasting;
  };
  [[nodiscard]] Given computeGiven(const HapticBody& body) const noexcept;

 private:
  class [[gnu::visibility("hidden")]] Row;
  /// Rows and friction of one face: a range of each.
  struct Face {
    std::size_t first_row, end_row;
    std::size_t first_friction, end_friction;
    double friction;  ///< greatest along a line of it, per impulse of all rows
    const HapticBody *a, *b;
    Vec3 j_W = Vec3::Zero();  ///< impulse on a in the step [N s]
    double lasting = 0.0;     ///< share of it that goes on
  };

  void addRow(const RigidContact& contact, const SupportBody& a, const SupportBody& b, double dt);
  double sweep(const Face& face, double dt) noexcept;
  [[nodiscard]] bool hasJoint(const SupportBody& body) const noexcept;
  [[nodiscard]] Vec3 computeImpulse(const Face& face) const noexcept;
  [[nodiscard]] Vec3 findImpulseBefore(const Face& face) const noexcept;

  btDiscreteDynamicsWorld& host_;
  btRigidBody ground_;  ///< stands for what the solver does not move
  std::vector<std::unique_ptr<Row>> rows_;
  std::vector<SupportLine> frictions_;
  std::vector<Face> faces_, last_faces_;
  std::vector<const btRigidBody*> jointed_;  ///< of the host, sorted
  int host_sweeps_ = 0;                      ///< of the host's solver; 0: the world has no rows
};

}  // namespace tandem
#pragma GCC visibility pop
