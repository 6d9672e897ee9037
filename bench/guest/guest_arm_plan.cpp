#include "bench/guest/guest_arm_plan.h"

#include <fmt/format.h>

#include "bench/guest/guest_acts.h"
#include "bench/guest/guest_case.h"
#include "bench/program/draw.h"

namespace tandem::demos::bench {
namespace {

constexpr std::uint64_t kArmStream = 0x61726d73U;  // tells these draws from a case's others
constexpr double kShare = 1.0 / 6.0;               // of the cases that have arms
constexpr double kBetweenArms = 0.25;              // [m]

GuestLinkJoint drawJoint(Draw& draw) {
  const double kind = draw.even(0.0, 1.0);
  if (kind < 0.5) return GuestLinkJoint::kRevolute;
  if (kind < 0.65) return GuestLinkJoint::kPrismatic;
  if (kind < 0.8) return GuestLinkJoint::kSpherical;
  return kind < 0.9 ? GuestLinkJoint::kFixed : GuestLinkJoint::kPlanar;
}

GuestLinkPlan drawLink(Draw& draw, int index) {
  GuestLinkPlan link;
  link.joint = drawJoint(draw);
  link.parent = draw.chance(0.8) ? index - 1 : draw.count(-1, index - 1);
  link.axis = draw.direction();
  link.half = Vec3(draw.even(0.02, 0.08), draw.even(0.01, 0.03), draw.even(0.01, 0.03));
  link.to_joint = Vec3(index == 0 ? 0.0 : 0.06, draw.even(-0.02, 0.02), 0.0);
  if (link.joint != GuestLinkJoint::kPlanar) link.to_centre = Vec3(link.half.x(), 0.0, 0.0);
  link.mass = draw.log(0.05, 2.0);
  link.has_shape = draw.chance(0.9);
  return link;
}

GuestArmPlan drawArm(Draw& draw, int place) {
  GuestArmPlan plan;
  plan.p_W = Vec3(draw.even(-0.2, 0.0), kBetweenArms * place - 0.1, draw.even(0.22, 0.35));
  if (draw.chance(0.3)) plan.base_mass = draw.log(0.2, 3.0);
  plan.has_base_shape = plan.base_mass > 0.0 || draw.chance(0.5);
  plan.is_damped = draw.chance(0.5);
  plan.can_sleep = draw.chance(0.3);
  const int count = draw.count(1, 5);
  for (int i = 0; i < count; ++i) plan.links.push_back(drawLink(draw, i));
  plan.seed = static_cast<std::uint64_t>(draw.count(0, 1 << 30));
  plan.has_tie = draw.chance(0.25);
  return plan;
}

}  // namespace

void drawArms(GuestCase& one) {
  Draw draw(one.seed ^ kArmStream, one.index);
  if (!draw.chance(kShare)) return;
  const int count = draw.chance(0.7) ? 1 : 2;
  for (int i = 0; i < count; ++i) one.arms.push_back(drawArm(draw, i));
  drawActsAmong(draw, one, armActs(), 0.08, true);
}

std::string describeArm(const GuestArmPlan& plan) {
  constexpr const char* kNames[] = {"revolute", "prismatic", "spherical", "fixed", "planar"};
  std::string text = plan.base_mass > 0.0 ? fmt::format("base of {:.3f} kg", plan.base_mass)
                                          : std::string("fixed base");
  text += fmt::format(" at {:.3f} {:.3f} {:.3f}", plan.p_W.x(), plan.p_W.y(), plan.p_W.z());
  for (const GuestLinkPlan& link : plan.links)
    text += fmt::format(", {} of {:.3f} kg on {}", kNames[static_cast<int>(link.joint)], link.mass,
                        link.parent);
  return text + (plan.has_tie ? ", a tie" : "");
}

}  // namespace tandem::demos::bench
