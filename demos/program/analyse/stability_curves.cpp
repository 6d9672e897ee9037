#include "analyse/stability_curves.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "tandem/coordination/contact_outlook.h"
#include "tandem/coordination/stability_advice.h"

#include "analyse/analysis.h"
#include "analyse/criteria.h"
#include "analyse/loop_of_scenario.h"

namespace tandem::demos {
namespace {

constexpr double kLongest = 0.2;  // delay of a curve [s]
const std::vector<double> kUsers = {2, 3, 4, 6, 8, 12, 16};

bool isStable(LoopSettings loop, LoopGain gain, double value) {
  setValue(loop, gain, value);
  return computeWorstRate(loop) < 0.0;
}

/// Makes a curve whose values are computed by jobs, one for each x.
void addCurve(CurveSet& set, const std::string& name, Jobs& jobs,
              const std::function<std::optional<double>(double x)>& compute) {
  // A vector keeps its values in place when it moves with its curve.
  auto& values = set.curves.emplace_back(Curve{name, {}}).values;
  values.resize(set.x.size());
  for (std::size_t i = 0; i < set.x.size(); ++i)
    jobs.emplace_back([value = &values[i], x = set.x[i], compute] { *value = compute(x); });
}

/// The loop with another scheme and delay.
LoopSettings change(LoopSettings loop, StandInKind kind, double delay) {
  loop.stand_in = kind;
  loop.delay = delay;
  return loop;
}

double computeHeldRate(LoopSettings loop, double users) {
  loop.hand = kHeldHand;
  loop.each.clear();
  loop.object_mass *= users / loop.users;
  loop.users = static_cast<int>(users);
  return computeWorstRate(loop);
}

/// Above the value if that is stable, and below if not.
std::optional<double> findLargest(const LoopSettings& loop, LoopGain gain) {
  constexpr double kStep = 1.2, kMost = 1e6, kLeast = 1e-2;  // [N/m]
  const double value = valueOf(loop, gain);
  const bool is_stable = isStable(loop, gain, value);
  return findBorder(loop, gain,
                    {value, is_stable ? kMost : kLeast, is_stable ? kStep : 1.0 / kStep});
}

/// A criterion over the delays of a set; empty where it allows no stiffness.
void addCriterion(const LoopSettings& loop, const char* name, CurveSet& set,
                  const std::function<double(double age)>& limit) {
  Curve& curve = set.curves.emplace_back(Curve{name, {}});
  for (const double delay : set.x) {
    const double most = limit(computeAge(delay, loop.packet_rate));
    curve.values.push_back(most > 0.0 ? std::optional(most) : std::nullopt);
  }
}

void addChainCriteria(const LoopSettings& loop, const DelayedChain& chain, CurveSet& set) {
  addCriterion(loop, "chain", set, [&](double age) { return limitByChain(chain, age); });
  addCriterion(loop, "every_delay", set, [&](double) { return limitAtEveryDelay(chain); });
  addCriterion(loop, "grounded_damper", set,
               [&](double age) { return limitByGroundedDamper(chain.damper, age); });
}

void addWallCriteria(const LoopSettings& loop, CurveSet& set) {
  const double b = loop.device_damping, B = loop.contact.damping, T = 1.0 / loop.haptic_rate;
  addCriterion(loop, "wall", set, [&](double) { return limitByWall(b, B, T); });
  addCriterion(loop, "colgate_schenkel", set,
               [&](double) { return limitByColgateSchenkel(b, B, T); });
}

/// Criteria are for two users who are alike and hear each other whole.
LoopSettings makePair(LoopSettings loop) {
  loop.object_mass *= 2.0 / loop.users;
  loop.users = 2;
  loop.each.clear();
  loop.mode = CoordinationMode::kSum;
  return loop;
}

}  // namespace

std::vector<double> listDelays(std::size_t steps) {
  std::vector<double> delays;
  for (std::size_t i = 0; i <= steps; ++i)
    delays.push_back(kLongest * static_cast<double>(i) / static_cast<double>(steps));
  return delays;
}

std::vector<StandInKind> listStandIns(const LoopSettings& loop) {
  if (loop.has_object) return {StandInKind::kNone, StandInKind::kHeld, StandInKind::kDynamic};
  return {StandInKind::kHeld, StandInKind::kDynamic};
}

void addDampingJobs(const LoopSettings& loop, CurveSet& set, Jobs& jobs) {
  constexpr double kFirst = 0.05, kMost = 200.0, kStep = 1.5;  // [N s/m], and the search's factor
  for (const StandInKind kind : listStandIns(loop))
    addCurve(set, schemeOf(kind), jobs, [=](double delay) -> std::optional<double> {
      LoopSettings there = change(loop, kind, delay);
      if (isStable(there, LoopGain::kDeviceDamping, 0.0)) return 0.0;
      there.device_damping = kFirst;
      if (computeWorstRate(there) < 0.0) return kFirst;
      return findBorder(there, LoopGain::kDeviceDamping, {kFirst, kMost, kStep});
    });
}

void addUserJobs(const LoopSettings& loop, CurveSet& set, Jobs& jobs) {
  set.x = kUsers;
  for (const StandInKind kind : listStandIns(loop)) {
    if (kind == StandInKind::kHeld) continue;
    const auto add = [&](const char* name, CoordinationMode mode, std::optional<double> share) {
      LoopSettings there = change(loop, kind, loop.delay);
      there.mode = mode;
      there.stand_in_share = share;
      addCurve(set, fmt::format("{}/{}", schemeOf(kind), name), jobs,
               [=](double users) { return computeHeldRate(there, users); });
    };
    add("sum", CoordinationMode::kSum, {});
    add("average", CoordinationMode::kAverage, {});
    if (kind == StandInKind::kDynamic && loop.has_object)
      add("average_whole", CoordinationMode::kAverage, 1.0);
  }
}

void addCoordinationLimitJobs(const LoopSettings& loop, CurveSet& set, Jobs& jobs) {
  if (!loop.has_object) return;
  const LoopSettings pair = makePair(loop);
  addCurve(set, "exact", jobs, [=](double delay) {
    return findLargest(change(pair, StandInKind::kNone, delay), LoopGain::kCoordinationStiffness);
  });
  // A user's device and copy move as one mass.
  const double mass = pair.device_mass + 0.5 * pair.object_mass;
  addChainCriteria(pair, {mass, pair.device_damping, pair.coordination.damping}, set);
}

void addContactLimitJobs(const LoopSettings& loop, CurveSet& set, Jobs& jobs) {
  const LoopSettings pair = makePair(loop);
  const StandInKind kind = loop.has_object ? StandInKind::kNone : StandInKind::kHeld;
  addCurve(set, "exact", jobs, [=](double delay) {
    return findLargest(change(pair, kind, delay), LoopGain::kContactStiffness);
  });
  addWallCriteria(pair, set);
  if (!loop.has_object)
    addChainCriteria(pair, {pair.device_mass, pair.device_damping, pair.contact.damping}, set);
}

void addFineJobs(const LoopSettings& loop, CurveSet& set, Jobs& jobs) {
  constexpr double kStep = 0.25e-3;  // [s]
  const double around = 2.0 / loop.packet_rate;
  const double first = std::max(0.0, loop.delay - around);
  const double last = std::min(loop.delay + around, kLongestDelay);
  const int steps = static_cast<int>((last - first) / kStep);
  set.x.clear();
  for (int i = 0; i <= steps; ++i) set.x.push_back(first + i * kStep);
  for (const StandInKind kind : listStandIns(loop))
    addCurve(set, schemeOf(kind), jobs,
             [=](double delay) { return computeWorstRate(change(loop, kind, delay)); });
}

void addTouchJobs(const LoopSettings& loop, CurveSet& set, Jobs& jobs) {
  constexpr double kStep = 0.05;  // [N s/m]
  constexpr int kSteps = 60;
  if (loop.has_object) return;
  set.x.clear();
  for (int i = 0; i <= kSteps; ++i) set.x.push_back(i * kStep);
  for (const double factor : {0.25, 0.5, 1.0, 2.0}) {
    LoopSettings there = change(makePair(loop), StandInKind::kHeld, loop.delay);
    there.contact.stiffness *= factor;
    addCurve(set, fmt::format("{:.4g}", there.contact.stiffness), jobs, [=](double damping) {
      LoopSettings touch = there;
      touch.device_damping = damping;
      return computeRestitution(touch);
    });
  }
}

}  // namespace tandem::demos
