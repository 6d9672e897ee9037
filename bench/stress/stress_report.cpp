#include "bench/stress/stress_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tandem::demos::bench {
namespace {

/// Sums and worst values over the cases of a kind.
struct KindSummary {
  std::size_t cases = 0, stable = 0, strict = 0, balanced = 0, late = 0, cut = 0, refused = 0,
              failed = 0;
  std::size_t failures[kStressFailureCount] = {};
  double worst_unaccounted = 0.0, worst_growth = 0.0, worst_jump = 0.0, simulated = 0.0;
  double worst_deviation = 0.0, worst_pin_gap = 0.0;
  std::uint64_t worst_case = 0;  ///< case with the worst energy error
  double worst_strict = 0.0;     ///< unaccounted, in cases that allow only kEnergyTolerance

  void include(const StressOutcome& outcome) {
    ++cases;
    stable += outcome.is_stable;
    cut += outcome.was_cut;
    refused += outcome.refused;
    late += outcome.isLate();
    balanced += outcome.unaccounted <= kEnergyTolerance;
    if (outcome.isStrict()) {
      ++strict;
      worst_strict = std::max(worst_strict, outcome.unaccounted);
    }
    simulated += outcome.simulated;
    const auto found = findFailures(outcome);
    failed += !found.empty();
    for (const StressFailure failure : found) ++failures[static_cast<int>(failure)];
    if (outcome.unaccounted > worst_unaccounted) {
      worst_unaccounted = outcome.unaccounted;
      worst_case = outcome.index;
    }
    if (outcome.is_stable) worst_growth = std::max(worst_growth, outcome.growth);
    worst_jump = std::max(worst_jump, outcome.jump);
    worst_deviation = std::max(worst_deviation, outcome.deviation);
    worst_pin_gap = std::max(worst_pin_gap, outcome.pin_gap);
  }
};

KindSummary summarise(const StressResult& result, int kind) {
  KindSummary summary;
  for (const StressOutcome& outcome : result.outcomes)
    if (kind < 0 || outcome.kind == kind) summary.include(outcome);
  return summary;
}

nlohmann::json makeSummaryJson(const KindSummary& summary) {
  nlohmann::json json = {{"cases", summary.cases},
                         {"stable", summary.stable},
                         {"strict", summary.strict},
                         {"balanced", summary.balanced},
                         {"late", summary.late},
                         {"cut", summary.cut},
                         {"refused", summary.refused},
                         {"failed", summary.failed},
                         {"simulated", summary.simulated},
                         {"worst_strict", summary.worst_strict},
                         {"worst_unaccounted", summary.worst_unaccounted},
                         {"worst_unaccounted_case", summary.worst_case},
                         {"worst_growth", summary.worst_growth},
                         {"worst_jump", summary.worst_jump},
                         {"worst_deviation", summary.worst_deviation},
                         {"worst_pin_gap", summary.worst_pin_gap}};
  for (int f = 0; f < kStressFailureCount; ++f)
    json["failures"][std::string(nameOf(static_cast<StressFailure>(f)))] = summary.failures[f];
  return json;
}

nlohmann::json makeOutcomeJson(const StressOutcome& outcome) {
  nlohmann::json failures = nlohmann::json::array();
  for (const StressFailure failure : findFailures(outcome)) failures.push_back(nameOf(failure));
  return {{"case", outcome.index},
          {"kind", nameOf(static_cast<StressKind>(outcome.kind))},
          {"failures", failures},
          {"stable", outcome.is_stable},
          {"cut", outcome.was_cut},
          {"simulated", outcome.simulated},
          {"unaccounted", outcome.unaccounted},
          {"unaccounted_time", outcome.unaccounted_time},
          {"allowed", outcome.allowed},
          {"peak", outcome.peak},
          {"jump", outcome.jump},
          {"growth", outcome.growth},
          {"deviation", outcome.deviation},
          {"pin_gap", outcome.pin_gap}};
}

std::string row(std::string_view name, const KindSummary& summary) {
  std::string text = fmt::format("{:<12}{:>8}{:>8}{:>8}{:>9}{:>8}", name, summary.cases,
                                 summary.stable, summary.strict, summary.balanced, summary.failed);
  for (const std::size_t count : summary.failures) text += fmt::format("{:>11}", count);
  return text +
         fmt::format("{:>12.1e}{:>12.1e}\n", summary.worst_strict, summary.worst_unaccounted);
}

std::string describe(const CouplerGains& gains) {
  return fmt::format("{:.4g} N/m, {:.4g} N s/m", gains.stiffness, gains.damping);
}

std::string_view shapeName(const Shape& shape) {
  constexpr std::string_view kNames[] = {"sphere", "box", "capsule", "plane"};
  return kNames[shape.index()];
}

nlohmann::json gainsJson(const CouplerGains& gains) {
  return {{"stiffness", gains.stiffness}, {"damping", gains.damping}};
}

nlohmann::json vectorJson(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

nlohmann::json makeStressJson(const StressResult& result) {
  nlohmann::json json = {
      {"format", "tandem-bench-stress"}, {"version", 1},
      {"quick", result.options.quick},   {"seed", result.options.seed},
      {"cases", result.options.cases},   {"energy_tolerance", kEnergyTolerance},
      {"seconds", result.seconds},       {"all", makeSummaryJson(summarise(result, -1))}};
  for (int kind = 0; kind < kStressKindCount; ++kind)
    json["kinds"][std::string(nameOf(static_cast<StressKind>(kind)))] =
        makeSummaryJson(summarise(result, kind));
  json["failed"] = nlohmann::json::array();
  for (const StressOutcome& outcome : result.outcomes)
    if (!findFailures(outcome).empty()) json["failed"].push_back(makeOutcomeJson(outcome));
  for (const StabilityMap& map : result.maps) {
    nlohmann::json cells = nlohmann::json::array();
    for (std::size_t k = 0; k < map.stiffness.size(); ++k) {
      nlohmann::json line = nlohmann::json::array();
      for (std::size_t r = 0; r < map.host_rates.size(); ++r) line.push_back(nameOf(map.at(k, r)));
      cells.push_back(line);
    }
    nlohmann::json one = {{"method", map.method},
                          {"stiffness", map.stiffness},
                          {"host_rates", map.host_rates},
                          {"cells", cells}};
    if (map.method == "force injection")
      for (const double stiffness : map.stiffness)
        one["step_limit"].push_back(computeInjectionLimit(stiffness));
    json["maps"].push_back(std::move(one));
  }
  return json;
}

std::string makeStressTable(const StressResult& result) {
  std::string text = fmt::format("{:<12}{:>8}{:>8}{:>8}{:>9}{:>8}", "kind", "cases", "stable",
                                 "strict", "balanced", "failed");
  for (int f = 0; f < kStressFailureCount; ++f)
    text += fmt::format("{:>11}", nameOf(static_cast<StressFailure>(f)));
  text += fmt::format("{:>12}{:>12}\n", "off, strict", "off, all");
  for (int kind = 0; kind < kStressKindCount; ++kind)
    text += row(nameOf(static_cast<StressKind>(kind)), summarise(result, kind));
  const KindSummary all = summarise(result, -1);
  text += row("all", all);
  text += fmt::format(
      "{:.1f} s simulated in {:.0f} s, seed {}; in {} cases a contact was found late, {} ended "
      "early\n",
      all.simulated, result.seconds, result.options.seed, all.late, all.cut);
  text += fmt::format("joints opened by {:.1e} m at most\n", all.worst_pin_gap);
  int listed = 0;
  for (const StressOutcome& outcome : result.outcomes) {
    const auto failures = findFailures(outcome);
    if (failures.empty() || ++listed > 10) continue;
    text +=
        fmt::format("case {} ({}):", outcome.index, nameOf(static_cast<StressKind>(outcome.kind)));
    for (const StressFailure failure : failures) text += fmt::format(" {}", nameOf(failure));
    text += fmt::format(", off by {:.1e} of the energy at {:.4f} s\n", outcome.unaccounted,
                        outcome.unaccounted_time);
  }
  text += "\nstiffness by host step, share of the grid:\n";
  for (const StabilityMap& map : result.maps) {
    std::size_t counts[4] = {};
    for (const Stability cell : map.cells) ++counts[static_cast<int>(cell)];
    const double share = 100.0 / static_cast<double>(map.cells.size());
    text +=
        fmt::format("{:<20}{:>5.0f} % stable{:>5.0f} % grows{:>5.0f} % not finite\n", map.method,
                    share * static_cast<double>(counts[0]), share * static_cast<double>(counts[1]),
                    share * static_cast<double>(counts[2]));
  }
  return text;
}

std::string describeCase(const StressCase& one) {
  std::string text = fmt::format(
      "case {} of seed {}: {}\n  host {:.2f} Hz, packets {:.1f} Hz, {:.3f} s, scheme {}\n"
      "  contact {}; coordination {}\n  proxy {:.4g} kg, {:.4g} N s/m, radius {:.4g} m\n",
      one.index, one.seed, nameOf(one.kind), 1.0 / one.host_step, one.packet_rate, one.duration,
      one.scheme, describe(one.contact), describe(one.coordination), one.proxy_mass,
      one.proxy_damping, one.radius);
  if (one.angular) text += fmt::format("  angular coordination {}\n", describe(*one.angular));
  text += fmt::format(
      "  network: delay {:.4g} s, jitter {:.4g} s, loss {:.2f}, duplicate {:.2f}, reorder {:.2f}\n"
      "  origin {:.4g} m away; friction {:.2f}; object damping {:.4g} N s/m\n",
      one.network.delay, one.network.jitter, one.network.loss, one.network.duplicate,
      one.network.reorder, one.origin_W.norm(), one.friction, one.object_damping);
  for (const StressBody& body : one.bodies)
    text += fmt::format("  {} {}: {:.4g} kg, {:.4g} m across, {:.4g} m/s, {:.4g} rad/s\n",
                        body.is_shared    ? "shared"
                        : body.mass > 0.0 ? "host's"
                                          : "fixed",
                        shapeName(body.shape), body.mass, 2.0 * computeBoundingRadius(body.shape),
                        body.start.v_W.norm(), body.start.w_W.norm());
  for (const StressUser& user : one.users)
    text += user.is_scripted
                ? fmt::format("  scripted user, {:.4g} m/s, leaps {:.4g} m\n", user.path.v_W.norm(),
                              user.path.leap_W.norm())
                : fmt::format(
                      "  user with a device of {:.4g} kg, {:.4g} N s/m, pushing with {:.4g} N\n",
                      user.device_mass, user.device_damping, user.hand_W.norm());
  return text;
}

nlohmann::json makeCaseJson(const StressCase& one, const StressOutcome& outcome) {
  nlohmann::json json = makeOutcomeJson(outcome);
  json["seed"] = one.seed;
  json["host_step"] = one.host_step;
  json["packet_rate"] = one.packet_rate;
  json["scheme"] = one.scheme;
  json["contact"] = gainsJson(one.contact);
  json["coordination"] = gainsJson(one.coordination);
  json["proxy_mass"] = one.proxy_mass;
  json["radius"] = one.radius;
  json["network"] = {{"delay", one.network.delay},
                     {"jitter", one.network.jitter},
                     {"loss", one.network.loss},
                     {"duplicate", one.network.duplicate},
                     {"reorder", one.network.reorder}};
  json["origin"] = vectorJson(one.origin_W);
  json["bodies"] = nlohmann::json::array();
  for (const StressBody& body : one.bodies)
    json["bodies"].push_back({{"shape", shapeName(body.shape)},
                              {"mass", body.mass},
                              {"shared", body.is_shared},
                              {"position", vectorJson(body.start.p_W)},
                              {"velocity", vectorJson(body.start.v_W)}});
  return json;
}

}  // namespace tandem::demos::bench
