#include "bench/speed/speed.h"

#include <algorithm>
#include <chrono>
#include <functional>

#include <fmt/format.h>
#include <sys/resource.h>

#include "bench/scenes/island_chain.h"

namespace tandem::demos::bench {
namespace {

const std::vector<SpeedWay> kAllWays = {SpeedWay::kBare60, SpeedWay::kBare240, SpeedWay::kWhole,
                                        SpeedWay::kIsland};

/// Duration of a measurement, and number of turns.
struct Effort {
  int turns;
  double block_us;  ///< least time of a block, which has at least one step
};

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Number of times that the system preempted this thread.
long countPreemptions() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

/// Measures again, a few times, if another program interrupted.
template <typename Measure>
void measureUndisturbed(Measure measure) {
  constexpr int kTries = 4;
  for (int tries = 0; tries < kTries; ++tries) {
    const long before = countPreemptions();
    measure();
    if (countPreemptions() == before) return;
  }
}

/// A running way, and the times of its blocks.
struct Contestant {
  SpeedWay way;
  std::unique_ptr<SpeedRun> run;
  std::vector<double> per_second, per_step, per_tick;

  void runBlock(double block_us) {
    SpeedTimes times;
    run->step(times);  // refills the caches that the others emptied
    measureUndisturbed([&] {
      times = {};
      do {
        run->step(times);
      } while (times.host + times.ticks < block_us);
    });
    const double step = times.host / times.host_steps;
    const double ticks = times.ticks / times.host_steps;
    per_step.push_back(step);
    per_second.push_back((step + ticks) * run->hostRate());
    per_tick.push_back(times.tick_count > 0 ? times.ticks / times.tick_count : 0.0);
  }
};

/// Median over turns of `compare` on two ways' blocks.
template <typename Compare>
double medianOver(const std::vector<double>& a, const std::vector<double>& b, Compare compare) {
  std::vector<double> compared;
  for (std::size_t turn = 0; turn < a.size(); ++turn) compared.push_back(compare(a[turn], b[turn]));
  return medianOf(std::move(compared));
}

void measureCase(SpeedCase& c, const std::vector<SpeedWay>& ways, const Effort& effort) {
  std::vector<Contestant> contestants;
  for (const SpeedWay way : ways)
    contestants.push_back({way, startSpeedRun(c.scene, way), {}, {}, {}});
  for (int turn = 0; turn < effort.turns; ++turn)
    for (Contestant& contestant : contestants) contestant.runBlock(effort.block_us);

  const Contestant& bare = contestants.front();
  const auto whole = std::find_if(contestants.begin(), contestants.end(),
                                  [](const auto& other) { return other.way == SpeedWay::kWhole; });
  for (const Contestant& one : contestants) {
    SpeedResult result{one.way, medianOf(one.per_second), medianOf(one.per_step),
                       medianOf(one.per_tick)};
    result.step_over_bare = medianOver(one.per_step, bare.per_step, std::minus<>());
    if (whole != contestants.end())
      result.times_cheaper = medianOver(whole->per_second, one.per_second, std::divides<>());
    c.results.push_back(result);
  }
}

double measureIslandTick(IslandChain chain, const Effort& effort) {
  constexpr int kTicks = 2000;  // two periods of the chain's motion
  for (int i = 0; i < kTicks; ++i) chain.tick();
  std::vector<double> times;
  for (int turn = 0; turn < effort.turns; ++turn) {
    std::chrono::duration<double, std::micro> wall{};
    measureUndisturbed([&] {
      const auto start = std::chrono::steady_clock::now();
      for (int i = 0; i < kTicks; ++i) chain.tick();
      wall = std::chrono::steady_clock::now() - start;
    });
    times.push_back(wall.count() / kTicks);
  }
  return medianOf(std::move(times));
}

const char* stateOf(bool awake) { return awake ? "active" : "asleep"; }

struct Plan {
  SpeedCase c;
  std::vector<SpeedWay> ways;
  int turns;
};

std::vector<Plan> makePlans(bool quick) {
  const std::vector<int> bodies =
      quick ? std::vector<int>{2, 100, 1000} : std::vector<int>{2, 10, 100, 1000, 5000};
  const std::vector<int> objects =
      quick ? std::vector<int>{1, 16, 256} : std::vector<int>{1, 4, 16, 64, 256};
  constexpr int kAround = 100;  // host's boxes around many shared objects
  const int turns = quick ? 9 : 61;
  std::vector<Plan> plans;
  for (const bool awake : {true, false})
    for (const int n : bodies)
      plans.push_back({{fmt::format("{} {}, cube pressed from both sides", n, stateOf(awake)),
                        {n, awake, 1, SpeedTouch::kCube},
                        {}},
                       kAllWays,
                       turns});
  plans.push_back(
      {{"1000 active, the same on the floor", {1000, true, 1, SpeedTouch::kOnFloor}, {}},
       kAllWays,
       turns});
  plans.push_back(
      {{"1000 active, row of 3 pushed", {1000, true, 1, SpeedTouch::kRow}, {}}, kAllWays, turns});
  // The difference is small compared with the whole, so there are more turns.
  for (const bool awake : {true, false})
    for (const int n : bodies)
      plans.push_back({{fmt::format("{} {}, nothing touched", n, stateOf(awake)),
                        {n, awake, 1, SpeedTouch::kNothing},
                        {}},
                       {SpeedWay::kBare60, SpeedWay::kIsland},
                       3 * turns});
  for (const SpeedTouch touch : {SpeedTouch::kCube, SpeedTouch::kNothing})
    for (const int n : objects)
      plans.push_back(
          {{fmt::format("{} shared, {} touched", n, touch == SpeedTouch::kCube ? "one" : "none"),
            {kAround, false, n, touch},
            {}},
           kAllWays,
           touch == SpeedTouch::kCube ? turns : 3 * turns});
  for (const int users : quick ? std::vector<int>{2, 8} : std::vector<int>{2, 4, 8, 16})
    plans.push_back({{fmt::format("{} users, cube pressed from both sides", users),
                      {2, false, 1, SpeedTouch::kCube, users},
                      {}},
                     {SpeedWay::kBare60, SpeedWay::kIsland},
                     turns});
  return plans;
}

/// Limit for untouched bodies in a host step: 1 %, or 0.05 us if that is more.
SpeedCheck checkNothingTouched(const SpeedCase& c) {
  const double bare = c.find(SpeedWay::kBare60)->us_per_step;
  return {c.name + ": host step beyond Bullet's own", c.find(SpeedWay::kIsland)->step_over_bare,
          std::max(0.01 * bare, 0.05), "us", false};
}

std::vector<SpeedCheck> makeChecks(const SpeedReport& report) {
  std::vector<SpeedCheck> checks;
  for (const SpeedCase& c : report.cases) {
    const SpeedScene& s = c.scene;
    if (s.touch == SpeedTouch::kNothing) {
      checks.push_back(checkNothingTouched(c));
      continue;
    }
    if (s.bodies != 1000 || !s.awake) continue;
    const double wanted = s.touch == SpeedTouch::kRow ? 10.0 : 17.0;
    checks.push_back({fmt::format("{}: times cheaper than at 1 kHz (Bullet alone {:.1f})", c.name,
                                  c.find(SpeedWay::kBare60)->times_cheaper),
                      c.find(SpeedWay::kIsland)->times_cheaper, wanted, "", true});
  }
  for (const IslandTick& tick : report.island_ticks)
    checks.push_back({"island tick, " + tick.name, tick.us, tick.limit_us, "us", false});
  return checks;
}

}  // namespace

const SpeedResult* SpeedCase::find(SpeedWay way) const {
  const auto found = std::find_if(results.begin(), results.end(),
                                  [&](const SpeedResult& result) { return result.way == way; });
  return found == results.end() ? nullptr : &*found;
}

SpeedReport measureSpeed(bool quick, const SpeedProgress& progress) {
  const double block_us = quick ? 1e3 : 3e3;
  SpeedReport report;
  std::vector<Plan> plans = makePlans(quick);
  for (std::size_t i = 0; i < plans.size(); ++i) {
    Plan& plan = plans[i];
    progress(plan.c.name, static_cast<double>(i) / static_cast<double>(plans.size()));
    measureCase(plan.c, plan.ways, {plan.turns, block_us});
    report.cases.push_back(std::move(plan.c));
  }
  const Effort effort{quick ? 9 : 41, 0.0};
  report.island_ticks = {
      {"lone couplers", measureIslandTick(makeLoneCouplers(), effort), 0.3},
      {"3 bodies in 3-D contact", measureIslandTick(makeThreeInContact(), effort), 1.5}};
  report.checks = makeChecks(report);
  return report;
}

}  // namespace tandem::demos::bench
