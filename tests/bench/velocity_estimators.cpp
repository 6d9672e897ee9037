// Compares estimators of a Falcon's velocity from its counted position:
//
//   tandem_velocity_estimators           a table
//   tandem_velocity_estimators --json    the same numbers, SI
//
// The name of an adaptive window contains its fit, its tolerance in counts, its stamp error [ms]
// and its longest length [ms].

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "velocity_candidates.h"
#include "velocity_motions.h"
#include "velocity_wall.h"

using namespace tandem::bench;

namespace {

constexpr double kDampings[] = {2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 60.0};  // [N s/m]

struct Stiffest {
  double stiffness = 0.0, damping = 0.0;
};

struct Row {
  std::string name, space;
  std::map<std::string, Accuracy> even;
  Accuracy known, unknown;          // results for the stroke with uneven readings
  double swing = 0.0;               // swing on a wall of 1000 N/m and 10 N s/m [m]
  Stiffest usual, best, best_late;  // walls at 10 N s/m; at the best damping; a period late
  double nanoseconds = 0.0;         // per reading, including the pose [ns]
};

Stiffest findBest(const Candidate* candidate, int late_by) {
  Stiffest best;
  for (const double damping : kDampings) {
    const double stiffness = findStiffest(candidate, {0.0, damping, late_by});
    if (stiffness > best.stiffness) best = {stiffness, damping};
  }
  return best;
}

void pressOnWalls(const Candidate* candidate, Row& row) {
  row.swing = measureSwing(candidate, {1000.0, 10.0, 0});
  row.usual = {findStiffest(candidate, {0.0, 10.0, 0}), 10.0};
  row.best = findBest(candidate, 0);
  row.best_late = findBest(candidate, 1);
}

double timeOf(const Candidate& candidate) {
  constexpr int kReadings = 200000;
  CountedGrip grip;
  std::vector<CountedGrip::Reading> readings;
  for (int i = 0; i < 1000; ++i)
    readings.push_back(grip.read(tandem::Vec3(1e-5 * i, 2e-6 * i, 0.125)));
  const Estimate estimate = candidate.make();
  tandem::Vec3 sum = tandem::Vec3::Zero();
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kReadings; ++i)
    sum += estimate(i * 1e-3, readings[static_cast<std::size_t>(i % 1000)]);
  const std::chrono::duration<double, std::nano> passed = std::chrono::steady_clock::now() - start;
  return sum.allFinite() ? passed.count() / kReadings : 0.0;
}

Row measure(const Candidate& candidate) {
  Row row{candidate.name, candidate.space, {}, {}, {}, 0.0, {}, {}, {}, 0.0};
  for (const Motion& motion : makeMotions()) {
    row.even[motion.name] = measureAccuracy(candidate, motion, Timing::kEven);
    if (motion.name != "stroke") continue;
    row.known = measureAccuracy(candidate, motion, Timing::kKnown);
    row.unknown = measureAccuracy(candidate, motion, Timing::kUnknown);
  }
  pressOnWalls(&candidate, row);
  row.nanoseconds = timeOf(candidate);
  return row;
}

Row measureTruth() {
  Row row;
  row.name = "true velocity";
  row.space = "-";
  for (const Motion& motion : makeMotions()) row.even[motion.name] = {};
  pressOnWalls(nullptr, row);
  return row;
}

void printHeader() {
  std::printf(
      "%-24s %-6s | error [mm/s]       stroke, uneven | 3 Hz, 10 mm       | turn      | wall "
      "1000/10, stiffest [N/m] and its damping [N s/m]\n"
      "%-24s %-6s | rest  slow stroke   known unknown | noise  lag error | lag error | swing   at "
      "10     best         a period late  |  ns\n",
      "", "", "estimator", "of");
}

void print(const Row& row) {
  const auto at = [&](const char* motion) { return row.even.at(motion); };
  const Accuracy sine = at("sine"), turn = at("turn");
  std::printf(
      "%-24s %-6s | %4.1f %5.2f %5.1f   %5.1f %6.1f | %5.2f %4.1f %5.1f | %4.1f %4.1f | %4.0f um "
      "%6.0f  %6.0f (%2.0f)  %6.0f (%2.0f)    | %4.0f\n",
      row.name.c_str(), row.space.c_str(), 1e3 * at("rest").error, 1e3 * at("slow").error,
      1e3 * at("stroke").error, 1e3 * row.known.error, 1e3 * row.unknown.error, 1e3 * sine.noise,
      1e3 * sine.lag, 1e3 * sine.error, 1e3 * turn.lag, 1e3 * turn.error, 1e6 * row.swing,
      row.usual.stiffness, row.best.stiffness, row.best.damping, row.best_late.stiffness,
      row.best_late.damping, row.nanoseconds);
  std::fflush(stdout);
}

nlohmann::json toJson(const Row& row) {
  nlohmann::json json = {{"estimator", row.name},
                         {"of", row.space},
                         {"stroke_known_error", row.known.error},
                         {"stroke_unknown_error", row.unknown.error},
                         {"wall_swing", row.swing},
                         {"stiffest_at_10", row.usual.stiffness},
                         {"stiffest", {row.best.stiffness, row.best.damping}},
                         {"stiffest_late", {row.best_late.stiffness, row.best_late.damping}},
                         {"ns", row.nanoseconds}};
  for (const auto& [motion, accuracy] : row.even)
    json[motion] = {{"error", accuracy.error}, {"noise", accuracy.noise}, {"lag", accuracy.lag}};
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  const bool is_json = argc == 2 && std::string(argv[1]) == "--json";
  if (argc > 1 && !is_json) {
    std::fprintf(stderr, "usage: tandem_velocity_estimators [--json]\n");
    return 2;
  }
  nlohmann::json all = nlohmann::json::array();
  if (!is_json) printHeader();
  const auto show = [&](const Row& row) {
    if (is_json)
      all.push_back(toJson(row));
    else
      print(row);
  };
  show(measureTruth());
  for (const Candidate& candidate : makeCandidates()) show(measure(candidate));
  if (is_json) std::printf("%s\n", all.dump(2).c_str());
  return 0;
}
