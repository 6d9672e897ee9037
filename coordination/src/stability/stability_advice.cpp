#include "tandem/coordination/stability_advice.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace tandem {
namespace {

constexpr double kRange = 1000.0;  // of a search, as a factor
constexpr double kBeyond = 1.2;    // of a remedy
constexpr double kBorderPrecision = 1e-5;

/// A gain, by its place in LoopGain.
struct GainRow {
  LoopGain gain;
  const char* key;
  const char* unit;
  double least;  ///< a search begins there if the gain is 0
  double (*get)(const LoopSettings& settings);
  void (*set)(LoopSettings& settings, double value);
};

/// The number that the members of `Path` lead to, one within the other.
template <auto... Path>
constexpr GainRow row(LoopGain gain, const char* key, const char* unit, double least) {
  return {gain,
          key,
          unit,
          least,
          [](const LoopSettings& s) { return (s.*....*Path); },
          [](LoopSettings& s, double value) { (s.*....*Path) = value; }};
}

using Gains = CouplerGains;
using Loop = LoopSettings;
constexpr GainRow kGains[] = {
    row<&Loop::coordination, &Gains::stiffness>(LoopGain::kCoordinationStiffness,
                                                "coordination.stiffness", "N/m", 1.0),
    row<&Loop::coordination, &Gains::damping>(LoopGain::kCoordinationDamping,
                                              "coordination.damping", "N s/m", 1e-2),
    row<&Loop::contact, &Gains::stiffness>(LoopGain::kContactStiffness, "contact.stiffness", "N/m",
                                           1.0),
    row<&Loop::contact, &Gains::damping>(LoopGain::kContactDamping, "contact.damping", "N s/m",
                                         1e-2),
    row<&Loop::device_damping>(LoopGain::kDeviceDamping, "device.damping", "N s/m", 1e-2),
    row<&Loop::delay>(LoopGain::kDelay, "network.delay", "s", 1e-3),
};

static_assert([] {
  for (std::size_t i = 0; i < std::size(kGains); ++i)
    if (static_cast<std::size_t>(kGains[i].gain) != i) return false;
  return true;
}());

constexpr const GainRow& rowOf(LoopGain gain) { return kGains[static_cast<std::size_t>(gain)]; }

double findMost(LoopGain gain, double value) {
  const double most = kRange * value;
  return gain == LoopGain::kDelay ? std::min(most, kLongestDelay) : most;
}

bool growsSlower(const ModeGrowth& a, const ModeGrowth& b) noexcept {
  return a.growth.rate < b.growth.rate;
}

double rateAt(LoopSettings settings, LoopGain gain, double value) {
  setValue(settings, gain, value);
  return computeWorstRate(settings);
}

bool isStable(const LoopSettings& settings, LoopGain gain, double value) {
  return rateAt(settings, gain, value) < 0.0;
}

/// The rate over the logarithm of a gain, by a change of 2 % each way.
double computeSlope(const LoopSettings& settings, LoopGain gain, double value) {
  constexpr double kChange = 0.02;
  if (value == 0.0) return 0.0;
  const double up = std::min(value * (1.0 + kChange), findMost(gain, value));
  const double down = value * (1.0 - kChange);
  return (rateAt(settings, gain, up) - rateAt(settings, gain, down)) / std::log(up / down);
}

/// A border with 20 % beyond it, if that is stable.
void offer(const LoopSettings& settings, const GainMargin& margin,
           const std::optional<double>& border, bool is_above, std::optional<Remedy>& best) {
  if (!border) return;
  const double value = is_above ? kBeyond * *border : *border / kBeyond;
  if (margin.gain == LoopGain::kDelay || value > findMost(margin.gain, *border)) return;
  const Remedy remedy{margin.gain, value, rateAt(settings, margin.gain, value)};
  if (!(remedy.rate < 0.0)) return;
  const auto change = [&](const Remedy& r) {
    return std::abs(std::log(r.value / std::max(valueOf(settings, r.gain), rowOf(r.gain).least)));
  };
  if (!best || change(remedy) < change(*best)) best = remedy;
}

/// Above the last border below which it is stable; empty if it is never, or always.
std::optional<double> findLargestStiffness(const LoopSettings& settings, const GainMargin& margin,
                                           bool is_stable) {
  if (is_stable) return margin.above;
  if (!margin.below) return 0.0;
  const double beyond = 1.0 + 10.0 * kBorderPrecision;
  return isStable(settings, margin.gain, *margin.below / beyond) ? margin.below : std::nullopt;
}

}  // namespace

const std::vector<LoopGain>& allLoopGains() {
  static const std::vector<LoopGain> all = [] {
    std::vector<LoopGain> gains;
    for (const GainRow& one : kGains) gains.push_back(one.gain);
    return gains;
  }();
  return all;
}

const char* name(LoopGain gain) noexcept { return rowOf(gain).key; }

const char* unit(LoopGain gain) noexcept { return rowOf(gain).unit; }

double valueOf(const LoopSettings& settings, LoopGain gain) noexcept {
  return rowOf(gain).get(settings);
}

void setValue(LoopSettings& settings, LoopGain gain, double value) noexcept {
  rowOf(gain).set(settings, value);
}

double computeWorstRate(const LoopSettings& settings) {
  double worst = -HUGE_VAL;
  for (const MotionMode mode : listLastingModes(settings))
    worst = std::max(worst, computeGrowthRate(settings, mode));
  return worst;
}

ModeGrowth computeWorstGrowth(const LoopSettings& settings) {
  std::vector<ModeGrowth> lasting;
  for (const MotionMode mode : listLastingModes(settings))
    lasting.push_back({mode, computeGrowth(settings, mode)});
  return *std::max_element(lasting.begin(), lasting.end(), &growsSlower);
}

const ModeGrowth& Advice::worst() const noexcept {
  return *std::max_element(modes.begin(), std::prev(modes.end()), &growsSlower);
}

std::optional<double> findBorder(const LoopSettings& settings, LoopGain gain,
                                 const BorderSearch& search) {
  const bool is_stable = computeWorstRate(settings) < 0.0;
  double stays = search.from, changes = search.from;
  do {
    if (changes == search.to) return std::nullopt;
    stays = changes;
    changes = search.step > 1.0 ? std::min(stays * search.step, search.to)
                                : std::max(stays * search.step, search.to);
  } while (isStable(settings, gain, changes) == is_stable);
  while (std::abs(changes / stays - 1.0) > kBorderPrecision) {
    const double middle = std::sqrt(stays * changes);
    (isStable(settings, gain, middle) == is_stable ? stays : changes) = middle;
  }
  return std::sqrt(stays * changes);
}

GainMargin computeMargin(const LoopSettings& settings, LoopGain gain, bool searches) {
  GainMargin margin{gain, valueOf(settings, gain), {}, {}, 0.0};
  margin.slope = computeSlope(settings, gain, margin.value);
  if (!searches) return margin;
  const double from = std::max(margin.value, rowOf(gain).least);
  const BorderSearch up{from, findMost(gain, from)};
  if (margin.value >= from)
    margin.below = findBorder(settings, gain, {from, from / kRange, 1.0 / up.step});
  margin.above = findBorder(settings, gain, up);
  return margin;
}

Advice advise(const LoopSettings& settings) {
  std::vector<GainMargin> margins;
  for (const LoopGain gain : allLoopGains()) margins.push_back(computeMargin(settings, gain));
  return advise(settings, std::move(margins));
}

Advice advise(const LoopSettings& settings, std::vector<GainMargin> margins) {
  Advice advice;
  for (const MotionMode mode : listModes(settings))
    advice.modes.push_back({mode, computeGrowth(settings, mode)});
  advice.margins = std::move(margins);
  const auto strongest = std::max_element(advice.margins.begin(), advice.margins.end(),
                                          [](const GainMargin& a, const GainMargin& b) {
                                            return std::abs(a.slope) < std::abs(b.slope);
                                          });
  if (strongest->slope != 0.0) advice.strongest = strongest->gain;
  const bool is_stable = advice.worst().growth.rate < 0.0;
  advice.largest_coordination_stiffness =
      findLargestStiffness(settings, advice.margins.front(), is_stable);
  if (is_stable) return advice;
  for (const GainMargin& margin : advice.margins) {
    offer(settings, margin, margin.above, true, advice.remedy);
    offer(settings, margin, margin.below, false, advice.remedy);
  }
  return advice;
}

}  // namespace tandem
