#pragma once

#include <vector>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Index of a body in its island, in the order in which bodies were added.
using BodyIndex = int;

/// Stands in for a body index: a fixed surface that is not a body of the island.
inline constexpr BodyIndex kStanding = -1;

/// A point at which a rigid body touches another body or a fixed surface, or is about to.
struct RigidContact {
  BodyIndex a = 0;
  BodyIndex b = kStanding;
  Vec3 p_W = Vec3::Zero();        ///< point of contact [m]
  Vec3 n_W = Vec3::UnitX();       ///< unit vector from b to a
  Vec3 v_W = Vec3::Zero();        ///< velocity of a fixed surface itself, such as a belt [m/s]
  double distance = 0.0;          ///< along n [m]; negative: they overlap
  double friction = 0.0;          ///< Coulomb's friction coefficient of the pair
  double restitution = 0.0;       ///< restitution coefficient of the pair
  double min_bounce_speed = 0.0;  ///< restitution acts above this approach speed [m/s]
  /// Greatest torque against rolling, and against spinning about n, per normal force [m].
  double rolling = 0.0, spinning = 0.0;
  /// The finder's mark of a fixed surface, for its own use.
  const void* surface = nullptr;
};

/// True for points of the same two bodies, or of a body and the same fixed surface.
template <typename One, typename Other>
[[nodiscard]] bool areOfOnePair(const One& x, const Other& y) noexcept {
  return x.a == y.a && x.b == y.b && x.surface == y.surface;
}

/// Finds rigid contacts between bodies of the island, and with fixed surfaces.
///
/// The island moves bodies and solves their contacts; others own the shapes and the search.
/// `bullet_bridge` searches with Bullet's narrowphase on private copies. All functions run in the
/// tick: no throw, no allocation after warm-up.
class ContactFinder {
 public:
  virtual ~ContactFinder() = default;

  /// Called once per tick, before its inner steps. Remembers the pairs that could touch while body
  /// b moves at most `reach[b]` [m] from `states[b]`, and sets `near[b]` for their bodies. Bodies
  /// with negative reach are ignored. Pairs without an awake body are skipped; a body that an awake
  /// one could touch is set awake.
  virtual void lookAround(const std::vector<RigidState>& states, const std::vector<double>& reach,
                          std::vector<char>& awake, std::vector<char>& near) noexcept = 0;

  /// Adds the contacts of those pairs at the given poses, up to the capacity of `contacts`. The
  /// order of pairs is fixed until the next lookAround(). Contacts at a distance may be missing.
  virtual void find(const std::vector<RigidState>& states,
                    std::vector<RigidContact>& contacts) noexcept = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
