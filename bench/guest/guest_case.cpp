#include "bench/guest/guest_case.h"

#include <algorithm>

#include <fmt/format.h>

#include "bench/guest/guest_acts.h"
#include "bench/program/draw.h"

namespace tandem::demos::bench {
namespace {

/// Distance from the scene at which a body is alone [m].
constexpr double kFarAway = 2.0;

/// Between two bodies at the start: none overlap [m].
constexpr double kApart = 0.11;

double drawRate(Draw& draw) {
  constexpr double kRates[] = {60.0, 120.0, 240.0, 1000.0};
  return draw.chance(0.6) ? kRates[draw.count(0, 3)] : draw.log(30.0, 1000.0);
}

void drawSteps(Draw& draw, GuestCase& one) {
  const double rate = drawRate(draw);
  one.frame = 1.0 / rate;
  if (draw.chance(0.3)) {
    one.max_substeps = draw.count(1, 4);
    one.fixed_step = draw.chance(0.5) ? one.frame / draw.count(1, 4) : 1.0 / 240.0;
  }
  one.is_caller = draw.chance(0.35);
}

GuestPlan drawBody(Draw& draw, int place, bool is_planar) {
  GuestPlan plan;
  plan.shape = static_cast<GuestShape>(draw.count(0, kGuestShapeCount - 1));
  plan.size = draw.even(0.015, 0.03);
  plan.mass = draw.log(0.05, 2.0);
  plan.seed = static_cast<std::uint64_t>(draw.count(0, 1 << 30));
  plan.p_W = Vec3(kApart * (place % 3 - 1), is_planar ? 0.0 : kApart * (place / 3 - 1),
                  draw.chance(0.7) ? plan.size + 0.002 : draw.even(0.05, 0.12));
  if (is_planar) plan.p_W.x() = kApart * (place - 3);
  if (draw.chance(0.2)) plan.q_WB = draw.rotation();
  if (draw.chance(0.1)) plan.role = GuestRole::kCharacter;
  return plan;
}

void drawBodies(Draw& draw, GuestCase& one) {
  one.shared = one.is_idle ? 0 : draw.count(draw.chance(0.1) ? 0 : 1, 4);
  const int plain = one.shared + draw.count(1, 5);
  for (int i = 0; i < plain; ++i) {
    GuestPlan plan = drawBody(draw, i, one.is_planar);
    if (i > 0 && draw.chance(0.1)) {
      plan.shares_shape_with = i - 1;
      plan.shape = one.bodies.back().shape;
      plan.size = one.bodies.back().size;
    }
    one.bodies.push_back(plan);
  }
  if (draw.chance(0.25)) {
    GuestPlan mover = drawBody(draw, plain, false);
    mover.role = GuestRole::kMover;
    mover.p_W = Vec3(-0.26, 0.0, mover.size + 0.005);
    one.bodies.push_back(mover);
  }
  if (draw.chance(0.25)) {
    GuestPlan ramp;
    ramp.role = GuestRole::kRamp;
    ramp.p_W = Vec3(0.35, 0.0, 0.0);
    ramp.q_WB = Quat(Eigen::AngleAxisd(-0.4, Vec3::UnitY()));
    one.bodies.push_back(ramp);
  }
  if (draw.chance(0.5)) {
    GuestPlan far = drawBody(draw, 0, false);
    far.role = GuestRole::kFar;
    // Bullet orders the contacts of a compound's children by those of all bodies.
    if (far.shape == GuestShape::kCompound) far.shape = GuestShape::kBox;
    far.p_W = Vec3(kFarAway, 0.0, 2.5 * far.size);
    one.bodies.push_back(far);
  }
  one.joints = draw.chance(0.4) ? draw.count(1, 2) : 0;
}

/// An act by a single host, or by all hosts now and then, if it `may_be_of_all`.
GuestActPlan drawAct(Draw& draw, const GuestCase& one, const GuestActRange& range, double time,
                     bool may_be_of_all, bool may_be_in_callback) {
  GuestActPlan plan;
  plan.time = time;
  plan.act = draw.count(range.first, range.last);
  plan.site =
      may_be_of_all && one.sites > 1 && draw.chance(0.2) ? -1 : draw.count(0, one.sites - 1);
  plan.in_callback = may_be_in_callback && draw.chance(0.1) &&
                     guestActs()[static_cast<std::size_t>(plan.act)].in_step;
  plan.seed = static_cast<std::uint64_t>(draw.count(0, 1 << 30));
  return plan;
}

void drawActs(Draw& draw, GuestCase& one) {
  double time = draw.even(0.0, 0.05);
  while (time < one.duration - 0.03) {
    one.acts.push_back(drawAct(draw, one, worldActs(), time, true, true));
    time += draw.chance(0.2) ? 0.0 : draw.even(0.0, 0.05);
  }
}

/// Acts that came later, and other broadphases, from a stream of draws of their own: all other
/// worlds of a seed are what they were.
void drawMore(GuestCase& one) {
  constexpr std::uint64_t kMoreStream = 0x6d6f7265U;
  Draw draw(one.seed ^ kMoreStream, one.index);
  if (!draw.chance(0.25)) return;
  one.broadphase = static_cast<GuestBroadphase>(draw.count(0, kGuestBroadphaseCount - 1));
  drawActsAmong(draw, one, moreActs(), 0.1, false);
}

constexpr const char* kBroadphaseNames[] = {"trees", "axis sweep", "32-bit axis sweep", "pairs"};
constexpr const char* kRoleNames[] = {"plain", "character", "mover", "ramp", "far"};
constexpr const char* kShapeNames[] = {"box",       "sphere",       "capsule x",    "capsule y",
                                       "capsule z", "cylinder",     "cone",         "hull",
                                       "compound",  "multi-sphere", "scaled convex"};
constexpr const char* kFloorNames[] = {"box", "plane", "mesh", "height field"};
constexpr const char* kHandNames[] = {"following", "resting", "pressing", "jumping", "gone", "far"};

}  // namespace

void drawActsAmong(Draw& draw, GuestCase& one, const GuestActRange& range, double apart,
                   bool in_callbacks) {
  for (double time = draw.even(0.0, 0.05); time < one.duration - 0.03;
       time += draw.even(0.0, apart))
    one.acts.push_back(drawAct(draw, one, range, time, false, in_callbacks));
  std::stable_sort(one.acts.begin(), one.acts.end(),
                   [](const GuestActPlan& a, const GuestActPlan& b) { return a.time < b.time; });
}

GuestCase drawGuestCase(std::uint64_t seed, std::uint64_t index) {
  Draw draw(seed, index);
  GuestCase one;
  one.seed = seed;
  one.index = index;
  one.is_idle = draw.chance(0.15);
  const double part = draw.even(0.0, 1.0);
  one.sites = one.is_idle || part < 0.4 ? 1 : part < 0.9 ? 2 : 3;
  one.duration = draw.even(0.1, 0.3);
  drawSteps(draw, one);
  one.delay = draw.chance(0.2) ? 0.0 : draw.even(0.0, 0.08);
  one.loss = draw.chance(0.2) ? 0.1 : 0.0;
  one.floor = static_cast<GuestFloor>(draw.count(0, kGuestFloorCount - 1));
  one.is_planar = draw.chance(0.1);
  one.max_neighbours = draw.chance(0.2) ? draw.count(0, 3) : 16;
  one.hand_feels = draw.chance(0.7);
  one.has_large_margins = draw.chance(0.05);
  for (int i = 0; i < one.sites; ++i)
    one.hands.push_back(static_cast<GuestHand>(draw.count(0, kGuestHandCount - 1)));
  if (one.is_idle && one.hand_feels) one.hands[0] = GuestHand::kFar;
  drawBodies(draw, one);
  one.world_ends_first = draw.chance(0.1);
  drawActs(draw, one);
  drawArms(one);
  drawMore(one);
  return one;
}

std::string describeCase(const GuestCase& one) {
  std::string text = fmt::format("case {} of seed {}: {} site{}{}, {:.3f} s, frames of {:.2f} ms",
                                 one.index, one.seed, one.sites, one.sites > 1 ? "s" : "",
                                 one.is_idle ? ", idle" : "", one.duration, 1e3 * one.frame);
  if (one.max_substeps > 0)
    text += fmt::format(" in up to {} steps of {:.2f} ms", one.max_substeps, 1e3 * one.fixed_step);
  text += fmt::format("\n  ticks by the {}, delay {:.1f} ms, loss {:.2f}, at most {} neighbours\n",
                      one.is_caller ? "caller" : "host step", 1e3 * one.delay, one.loss,
                      one.max_neighbours);
  text +=
      fmt::format("  floor: {}{}{}{}; hands:", kFloorNames[static_cast<int>(one.floor)],
                  one.is_planar ? ", planar" : "", one.has_large_margins ? ", large margins" : "",
                  one.world_ends_first ? ", world ends before its site" : "");
  for (const GuestHand hand : one.hands)
    text += fmt::format(" {}", kHandNames[static_cast<int>(hand)]);
  text += fmt::format("; {} joints; broadphase: {}\n", one.joints,
                      kBroadphaseNames[static_cast<int>(one.broadphase)]);
  for (std::size_t b = 0; b < one.bodies.size(); ++b) {
    const GuestPlan& plan = one.bodies[b];
    text += fmt::format("  body {}: {} {}{}, {:.3f} kg, {:.1f} mm, at {:.3f} {:.3f} {:.3f}\n", b,
                        kRoleNames[static_cast<int>(plan.role)],
                        kShapeNames[static_cast<int>(plan.shape)],
                        static_cast<int>(b) < one.shared ? ", shared" : "", plan.mass,
                        1e3 * plan.size, plan.p_W.x(), plan.p_W.y(), plan.p_W.z());
  }
  for (std::size_t a = 0; a < one.arms.size(); ++a)
    text += fmt::format("  arm {}: {}\n", a, describeArm(one.arms[a]));
  for (const GuestActPlan& act : one.acts)
    text += fmt::format("  {:.4f} s, {}: {}{}\n", act.time,
                        act.site < 0 ? "all hosts" : fmt::format("host {}", act.site + 1),
                        guestActs()[static_cast<std::size_t>(act.act)].name,
                        act.in_callback ? " (in a callback)" : "");
  return text;
}

}  // namespace tandem::demos::bench
