#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/coordination/types.h"

#include "bench/guest/guest_arm_plan.h"

namespace tandem::demos::bench {

/// Shapes of the bodies of a random world.
enum class GuestShape {
  kBox,
  kSphere,
  kCapsuleX,
  kCapsuleY,
  kCapsuleZ,
  kCylinder,
  kCone,
  kHull,
  kCompound,
  kMultiSphere,
  kScaledConvex,
};
inline constexpr int kGuestShapeCount = 11;

enum class GuestFloor { kBox, kPlane, kMesh, kHeightField };
inline constexpr int kGuestFloorCount = 4;

/// Bullet's searches for bodies whose boxes meet.
enum class GuestBroadphase { kTrees, kAxisSweep, kAxisSweep32, kPairs };
inline constexpr int kGuestBroadphaseCount = 4;

/// Parts that a body plays.
enum class GuestRole {
  kPlain,      ///< a dynamic body near the hand
  kCharacter,  ///< may not turn, walks
  kMover,      ///< kinematic, moved in each step
  kRamp,       ///< standing and oblique
  kFar,        ///< alone, far from all others: the twin has it to the bit
};

/// Motions of a user's hand.
enum class GuestHand { kFollowing, kResting, kPressing, kJumping, kGone, kFar };
inline constexpr int kGuestHandCount = 6;

/// A body of a random world at its start.
struct GuestPlan {
  GuestRole role = GuestRole::kPlain;
  GuestShape shape = GuestShape::kBox;
  double size = 0.02;  ///< about half its width [m]
  double mass = 0.0;   ///< [kg]
  Vec3 p_W = Vec3::Zero();
  Quat q_WB = Quat::Identity();
  int shares_shape_with = -1;  ///< an earlier body with the same shape object
  std::uint64_t seed = 0;      ///< of details of its shape
};

/// Something that a host does at run time.
struct GuestActPlan {
  double time = 0.0;         ///< [s]
  int site = 0;              ///< the host that does it; -1: all do
  int act = 0;               ///< index in guestActs()
  bool in_callback = false;  ///< done in the host's own pre-tick callback
  std::uint64_t seed = 0;    ///< of its draws
};

/// A random world in which hosts do at run time what hosts do.
struct GuestCase {
  std::uint64_t seed = 0, index = 0;
  int sites = 1;
  double duration = 0.4;         ///< [s]
  double frame = 1.0 / 60.0;     ///< time of a stepSimulation() call [s]
  int max_substeps = 0;          ///< as stepSimulation() takes it
  double fixed_step = 1.0 / 60;  ///< with sub-steps [s]
  bool is_caller = false;        ///< TickSource::kCaller
  double delay = 0.0, loss = 0.0;
  GuestFloor floor = GuestFloor::kBox;
  GuestBroadphase broadphase = GuestBroadphase::kTrees;
  bool is_planar = false;  ///< all bodies stay in the plane y = 0
  /// Nothing is shared, nobody connected, the hand far or without feeling for moving bodies: the
  /// world must be the twin's to the bit.
  bool is_idle = false;
  bool hand_feels = true;          ///< SiteSettings::hand_feels_moving_bodies
  bool has_large_margins = false;  ///< cones and hulls with Bullet's margin, larger than they are
  int shared = 0;                  ///< the first so many bodies are shared
  int max_neighbours = 16;
  int joints = 0;
  bool world_ends_first = false;
  std::vector<GuestHand> hands;  ///< one per site
  std::vector<GuestPlan> bodies;
  std::vector<GuestArmPlan> arms;  ///< the world is one with multi-bodies if there is any
  std::vector<GuestActPlan> acts;

  [[nodiscard]] double step() const { return max_substeps > 0 ? fixed_step : frame; }
};

class Draw;
struct GuestActRange;

/// Draws acts of `range` by single hosts, up to `apart` [s] from one to the next, among those of
/// the case in the order of time. A tenth of those that may are done in the host's callback, if
/// `in_callbacks`.
void drawActsAmong(Draw& draw, GuestCase& one, const GuestActRange& range, double apart,
                   bool in_callbacks);

/// Pure: equal seeds and indices give equal cases.
[[nodiscard]] GuestCase drawGuestCase(std::uint64_t seed, std::uint64_t index);

/// Several lines about the case and its acts.
[[nodiscard]] std::string describeCase(const GuestCase& one);

}  // namespace tandem::demos::bench
