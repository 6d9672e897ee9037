#pragma once

#include <vector>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Index of a body in its island, in the order in which bodies were added.
using BodyIndex = int;

/// In place of a body: what stands and is no body of the island.
inline constexpr BodyIndex kStanding = -1;

/// A point at which two rigid bodies, or a body and something standing, touch or are about to.
struct RigidContact {
  BodyIndex a = 0;
  BodyIndex b = kStanding;
  Vec3 p_W = Vec3::Zero();        ///< where they touch
  Vec3 n_W = Vec3::UnitX();       ///< unit vector from b to a
  Vec3 v_W = Vec3::Zero();        ///< velocity of a standing surface itself, a belt [m/s]
  double distance = 0.0;          ///< along n [m]; negative: they overlap
  double friction = 0.0;          ///< Coulomb's coefficient of the pair
  double restitution = 0.0;       ///< of the pair
  double min_bounce_speed = 0.0;  ///< restitution acts from this approach speed on [m/s]
};

/// Who finds rigid contacts of the island's bodies, among themselves and with what stands around.
///
/// The island moves bodies and solves their contacts; shapes and the search for contact are
/// somebody else's: `bullet_bridge` searches with Bullet's narrowphase on private copies. All
/// functions run in the tick: no throw, no allocation after warm-up.
class ContactFinder {
 public:
  virtual ~ContactFinder() = default;

  /// Once per tick, before its inner steps: remembers the pairs that could touch while body b moves
  /// no further than `reach[b]` [m] from `states[b]`, and sets `near[b]` for each body of them.
  /// Bodies of negative reach are not there. A pair of which no body has `awake[b]` set is left
  /// out; a body that an awake one could touch is set awake.
  virtual void lookAround(const std::vector<RigidState>& states, const std::vector<double>& reach,
                          std::vector<char>& awake, std::vector<char>& near) noexcept = 0;

  /// Adds the contacts of those pairs at the given poses; pair by pair in an order that does not
  /// change until the next lookAround(), as many as `contacts` has capacity for. Contacts at a
  /// distance may be left out.
  virtual void find(const std::vector<RigidState>& states,
                    std::vector<RigidContact>& contacts) noexcept = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
