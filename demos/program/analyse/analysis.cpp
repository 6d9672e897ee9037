#include "analyse/analysis.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analyse/jobs.h"

namespace tandem::demos {
namespace {

/// "halves in 0.3 s"
std::string describeTime(double rate) {
  return fmt::format("{} in {:.3g} s", rate < 0.0 ? "halves" : "doubles",
                     std::log(2.0) / std::abs(rate));
}

std::string describeBorder(const std::optional<double>& border, double value) {
  if (!border) return fmt::format("{:>12}{:>10}", "none", "");
  const double margin = value > 0.0 ? 20.0 * std::log10(*border / value) : 0.0;
  return fmt::format("{:>12.6g}{:>10}", *border,
                     value > 0.0 ? fmt::format("{:+.1f} dB", margin) : "");
}

nlohmann::json orNull(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

std::string describeModes(const Analysis& a) {
  std::string text = fmt::format("{:<28}{:>12}{:>10}  {:<22}{}\n", "motion", "rate [1/s]", "[Hz]",
                                 "", "held hand [1/s]");
  for (std::size_t i = 0; i < a.advice.modes.size(); ++i) {
    const auto& [mode, growth] = a.advice.modes[i];
    text += fmt::format("{:<28}{:>+12.4f}{:>10.1f}  {:<22}{}\n", explain(mode), growth.rate,
                        growth.frequency, describeTime(growth.rate),
                        i < a.held_rates.size() ? fmt::format("{:+.4f}", a.held_rates[i]) : "");
  }
  return text;
}

std::string describeGains(const Analysis& a) {
  std::string text =
      fmt::format("\n{:<24}{:>10} {:<6}{:>12}{:>22}\n", "gain", "now", "", "border below", "above");
  for (const GainMargin& m : a.advice.margins)
    text += fmt::format("{:<24}{:>10.6g} {:<6}{}{}\n", name(m.gain), m.value, unit(m.gain),
                        describeBorder(m.below, m.value), describeBorder(m.above, m.value));
  return text;
}

std::string describeVerdict(const Analysis& a) {
  const Advice& advice = a.advice;
  const bool is_stable = isStable(a);
  const ModeGrowth& worst = advice.worst();
  std::string text =
      fmt::format("\n{}: motion {} {}.\n", is_stable ? "Stable" : "Unstable with lasting contact",
                  explain(worst.mode), describeTime(worst.growth.rate));
  for (std::size_t i = 0; i < worst.growth.shares.size(); ++i)
    text +=
        fmt::format("{} {:+.2f}{}", i == 0 ? "In it move: user 1" : fmt::format("user {}", i + 1),
                    worst.growth.shares[i], i + 1 < worst.growth.shares.size() ? ", " : ".\n");
  if (!is_stable && std::ranges::all_of(a.held_rates, [](double rate) { return rate < 0.0; }))
    text += "Hands that hold their devices (300 N/m, 5 N s/m) calm it.\n";
  if (advice.remedy)
    text += fmt::format("Smallest change that calms it, with 20 % to spare: {} = {:.4g} {}.\n",
                        name(advice.remedy->gain), advice.remedy->value, unit(advice.remedy->gain));
  if (!is_stable && !advice.remedy) text += "No single gain calms it.\n";
  if (const auto most = advice.largest_coordination_stiffness)
    text += *most > 0.0
                ? fmt::format("Largest coordination.stiffness at this delay: {:.4g} N/m.\n", *most)
                : "At this delay no coordination.stiffness is stable.\n";
  if (advice.strongest) text += fmt::format("Most depends on {}.\n", name(*advice.strongest));
  if (a.worst_phase)
    text += fmt::format(
        "Live, packets drift against each other: the worst of 8 phases has {:+.4g} 1/s.\n",
        *a.worst_phase);
  text += fmt::format(
      "Half a packet less and more delay, with jitter: the worst has {:+.4g} 1/s, "
      "at {:.4g} ms.\n",
      a.worst_delay.rate, 1e3 * a.worst_delay.delay);
  if (std::abs(a.packet_rate / a.loop.packet_rate - 1.0) > 1e-9)
    text += fmt::format("network.rate = {} is taken as {:.9g} Hz, which meets the ticks again.\n",
                        a.loop.packet_rate, a.packet_rate);
  text += fmt::format("Moving on together each user feels {:.3g} N s/m.\n", a.drag);
  return text;
}

std::string describeContact(const Analysis& a) {
  if (!a.contact) return {};
  std::string text = fmt::format("A touch gives back {:.3g} of the speed", a.contact->restitution);
  if (a.contact->changes)
    text += fmt::format(": at a held user contact changes about {:.0f} times until it rests",
                        *a.contact->changes);
  text += ".\n";
  if (a.contact->comes_and_goes)
    text += fmt::format("Contact comes and goes as long as they push, about each {:.2g} s.\n",
                        a.contact->period);
  return text;
}

/// The searches for borders take nearly all of the time.
std::vector<GainMargin> computeMargins(const LoopSettings& loop) {
  std::vector<GainMargin> margins(allLoopGains().size());
  Jobs jobs;
  for (std::size_t i = 0; i < margins.size(); ++i)
    jobs.emplace_back(
        [&loop, &margins, i] { margins[i] = computeMargin(loop, allLoopGains()[i]); });
  runOnAllCores(jobs, [](double) {});
  return margins;
}

/// Many users take too long: the cost grows with the cube of their number.
std::optional<double> findWorstPhase(const LoopSettings& loop) {
  constexpr int kMostUsers = 4, kPhases = 8;
  if (loop.users > kMostUsers) return std::nullopt;
  double worst = -HUGE_VAL;
  for (int i = 0; i < kPhases; ++i)
    worst = std::max(worst, computeRateAtPhase(loop, static_cast<double>(i) / kPhases));
  return worst;
}

void lookAtDelays(const LoopSettings& loop, double jitter, Analysis& analysis) {
  constexpr int kDelays = 9;
  const double half = 0.5 / loop.packet_rate;
  const double least = std::max(0.0, loop.delay - half - jitter);
  const double most = std::min(kLongestDelay, loop.delay + half + jitter);
  analysis.worst_delay.rate = -HUGE_VAL;
  for (int i = 0; i < kDelays; ++i) {
    LoopSettings there = loop;
    there.delay = least + (most - least) * i / (kDelays - 1);
    const double rate = computeWorstRate(there);
    if (rate > analysis.worst_delay.rate) analysis.worst_delay = {rate, there.delay};
  }
}

}  // namespace

Analysis analyse(const LoopSettings& loop, double jitter) {
  Analysis analysis;
  analysis.loop = loop;
  analysis.advice = advise(loop, computeMargins(loop));
  LoopSettings held = loop;
  held.hand = kHeldHand;
  for (const MotionMode mode : listLastingModes(loop))
    analysis.held_rates.push_back(computeGrowthRate(held, mode));
  analysis.packet_rate = findAnalysedPacketRate(loop);
  analysis.drag = computeDrag(loop);
  analysis.worst_phase = findWorstPhase(loop);
  lookAtDelays(loop, jitter, analysis);
  if (!loop.has_object) analysis.contact = computeOutlook(loop);
  return analysis;
}

const char* explain(MotionMode mode) noexcept {
  switch (mode) {
    case MotionMode::kCommon:
      return "all together";
    case MotionMode::kDifference:
      return "against each other";
    case MotionMode::kAny:
      return "of all";
    case MotionMode::kDeaf:
      break;
  }
  return "before the others answer";
}

bool isStable(const Analysis& analysis) noexcept {
  return analysis.advice.worst().growth.rate < 0.0;
}

bool isStableAtWorst(const Analysis& analysis) noexcept {
  return isStable(analysis) && analysis.worst_delay.rate < 0.0 &&
         analysis.worst_phase.value_or(-1.0) < 0.0;
}

nlohmann::json toJson(const Analysis& a) {
  nlohmann::json json;
  json["stable"] = isStable(a);
  for (std::size_t i = 0; i < a.advice.modes.size(); ++i) {
    const Growth& growth = a.advice.modes[i].growth;
    nlohmann::json mode = {{"name", name(a.advice.modes[i].mode)},
                           {"rate", growth.rate},
                           {"frequency", growth.frequency}};
    if (!growth.shares.empty()) mode["users"] = growth.shares;
    if (i < a.held_rates.size()) mode["held_rate"] = a.held_rates[i];
    json["modes"].push_back(std::move(mode));
  }
  for (const GainMargin& m : a.advice.margins)
    json["gains"].push_back({{"key", name(m.gain)},
                             {"value", m.value},
                             {"down", orNull(m.below)},
                             {"up", orNull(m.above)},
                             {"slope", m.slope}});
  if (const auto& remedy = a.advice.remedy)
    json["remedy"] = {
        {"key", name(remedy->gain)}, {"value", remedy->value}, {"rate", remedy->rate}};
  if (a.advice.strongest) json["strongest"] = name(*a.advice.strongest);
  json["largest_coordination_stiffness"] = orNull(a.advice.largest_coordination_stiffness);
  json["packet_rate"] = a.packet_rate;
  json["drag"] = a.drag;
  json["worst_phase_rate"] = orNull(a.worst_phase);
  json["worst_delay"] = {{"rate", a.worst_delay.rate}, {"delay", a.worst_delay.delay}};
  if (a.contact)
    json["contact"] = {{"comes_and_goes", a.contact->comes_and_goes},
                       {"period", a.contact->period},
                       {"restitution", a.contact->restitution},
                       {"changes", orNull(a.contact->changes)}};
  return json;
}

std::string describe(const Analysis& a) {
  return describeModes(a) + describeGains(a) + describeVerdict(a) + describeContact(a);
}

}  // namespace tandem::demos
