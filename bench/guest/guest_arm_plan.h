#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/coordination/types.h"

namespace tandem::demos::bench {

struct GuestCase;

/// The joint between a link and its parent.
enum class GuestLinkJoint { kRevolute, kPrismatic, kSpherical, kFixed, kPlanar };

/// A link of an arm: a box that hangs on its parent by a joint.
struct GuestLinkPlan {
  GuestLinkJoint joint = GuestLinkJoint::kRevolute;
  int parent = -1;                                         ///< an earlier link; -1: the base
  Vec3 axis = Vec3::UnitY();                               ///< of the joint
  Vec3 half = Vec3::Zero();                                ///< of the box [m]
  Vec3 to_joint = Vec3::Zero(), to_centre = Vec3::Zero();  ///< from the parent's centre on [m]
  double mass = 0.0;                                       ///< [kg]
  bool has_shape = true;
};

/// A multi-body of a random world at its start.
struct GuestArmPlan {
  Vec3 p_W = Vec3::Zero();  ///< of its base
  double base_mass = 0.0;   ///< 0: the base is fixed [kg]
  bool has_base_shape = false;
  bool is_damped = false, can_sleep = false;
  std::vector<GuestLinkPlan> links;
  std::uint64_t seed = 0;  ///< of its motors and limits
  bool has_tie = false;
};

/// Gives one case in six an arm or two and acts for them, from a stream of draws of its own. So a
/// case without arms is what it was before there were arms.
void drawArms(GuestCase& one);

/// A line about an arm.
[[nodiscard]] std::string describeArm(const GuestArmPlan& plan);

}  // namespace tandem::demos::bench
