// Borders and growth rates of the analysis against the simulator, at settings by chance. Each row
// prints its seed.

#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tandem/coordination/stability_advice.h"

#include "net/virtual_net.h"
#include "stability/drawn/drawn_loops.h"
#include "stability/drawn/simulated_growth.h"

namespace tandem {
namespace {

using test::Random;
using test::SimulatedGrowth;

constexpr std::uint64_t kSeed = 2009;  // of the first row
constexpr double kWithin = 0.005;      // of a border, on each side

/// Settings at a border of one gain.
struct Border {
  LoopSettings settings;
  LoopGain gain{};
  double value = 0.0;
  int draws = 0;  ///< that it took: others have no border

  [[nodiscard]] LoopSettings beside(double part) const {
    LoopSettings there = settings;
    setValue(there, gain, value * (1.0 + part));
    return there;
  }
};

Border drawBorder(Random& random) {
  for (Border border;;) {
    ++border.draws;
    border.settings = test::drawLoop(random);
    const auto& gains = allLoopGains();
    border.gain = gains[static_cast<std::size_t>(random.below(static_cast<int>(gains.size())))];
    const bool prefers_above = random.below(2) == 0;
    const GainMargin margin = computeMargin(border.settings, border.gain);
    const auto& first = prefers_above ? margin.above : margin.below;
    const auto& found = first ? first : prefers_above ? margin.below : margin.above;
    if (!found) continue;
    border.value = *found;
    setValue(border.settings, border.gain, border.value);
    return border;
  }
}

/// What a run of the simulator says of a sign.
enum class Verdict { kAgrees, kDiffers, kUndecided };

struct Side {
  double predicted = 0.0;
  std::optional<SimulatedGrowth> seen;

  /// A rate that the fit does not tell from 0 decides nothing.
  [[nodiscard]] Verdict judge() const {
    if (!seen || !(3.0 * seen->worst().spread < std::abs(seen->worst().rate)))
      return Verdict::kUndecided;
    return seen->worst().rate * predicted > 0.0 ? Verdict::kAgrees : Verdict::kDiffers;
  }
  [[nodiscard]] double rate() const { return seen ? seen->worst().rate : std::nan(""); }
};

Side lookAt(const LoopSettings& settings) {
  return {computeWorstRate(settings), test::simulateGrowth(settings)};
}

/// Nearest parts of the border at which the predicted signs differ: another may be close.
double findPart(const Border& border) {
  double part = kWithin;
  for (int i = 0; i < 3; ++i, part *= 0.2)
    if (computeWorstRate(border.beside(-part)) * computeWorstRate(border.beside(part)) < 0.0) break;
  return part;
}

// On both sides of a predicted border, 0.5 % away, runs grow and fade as predicted.
TEST(DrawnRow, HasTheBorderOfRuns) {
  const auto count = static_cast<int>(test::readCount("TANDEM_STABILITY_ROWS", 6));
  const std::uint64_t first = test::readCount("TANDEM_STABILITY_SEED", kSeed);
  int undecided = 0;
  double worst = 0.0;
  for (int row = 0; row < count; ++row) {
    const std::uint64_t seed = first + static_cast<std::uint64_t>(row);
    Random random(seed);
    const Border border = drawBorder(random);
    const double part = findPart(border);
    const Side below = lookAt(border.beside(-part)), above = lookAt(border.beside(part));
    const Side at = lookAt(border.settings);
    // Runs have their border where the line through the rates of both sides has it.
    const double off = -2.0 * part * (at.rate() - at.predicted) / (above.rate() - below.rate());
    fmt::print(
        "row {:2} seed {} draws {}: {} | {} = {:.6g} +-{:g} % | predicted {:+.3g} {:+.3g} | seen "
        "{:+.6g} {:+.6g} | off {:+.5f} %\n",
        row + 1, seed, border.draws, test::describe(border.settings), name(border.gain),
        border.value, 100.0 * part, below.predicted, above.predicted, below.rate(), above.rate(),
        100.0 * off);
    SCOPED_TRACE(fmt::format("row {}: {}", row + 1, test::describeGains(border.settings)));
    EXPECT_NE(below.judge(), Verdict::kDiffers);
    EXPECT_NE(above.judge(), Verdict::kDiffers);
    if (below.judge() != Verdict::kAgrees || above.judge() != Verdict::kAgrees) {
      ++undecided;
      fmt::print("  not decided\n");
    } else {
      worst = std::max(worst, std::abs(off));
    }
  }
  fmt::print("{} rows, {} not decided, border off by {:.5f} % at most\n", count, undecided,
             100.0 * worst);
  EXPECT_LT(worst, kWithin);
  EXPECT_LE(undecided, count / 10);
}

/// Settings whose rate a run can tell: neither fast nor nearly 0.
LoopSettings drawPoint(Random& random, bool grows) {
  for (;;) {
    const LoopSettings settings = test::drawLoop(random);
    const double rate = computeWorstRate(settings);
    if ((rate > 0.0) == grows && std::abs(rate) > 0.02 && std::abs(rate) < 5.0) return settings;
  }
}

TEST(DrawnPoint, GrowsAsPredicted) {
  const auto count = static_cast<int>(test::readCount("TANDEM_STABILITY_POINTS", 6));
  const std::uint64_t first = test::readCount("TANDEM_STABILITY_SEED", kSeed) + 1000;
  constexpr double kPrecision = 0.01;
  int undecided = 0;
  double worst = 0.0;
  for (int point = 0; point < count; ++point) {
    const std::uint64_t seed = first + static_cast<std::uint64_t>(point);
    Random random(seed);
    const LoopSettings settings = drawPoint(random, point % 2 == 0);
    const Side side = lookAt(settings);
    const double off = side.rate() / side.predicted - 1.0;
    fmt::print("point {:2} seed {}: {} | predicted {:+.8g} | seen {:+.8g} | off {:+.5f} %\n",
               point + 1, seed, test::describe(settings), side.predicted, side.rate(), 100.0 * off);
    if (!side.seen || !side.seen->worst().isSure(0.3 * kPrecision)) {
      ++undecided;
      fmt::print("  not decided\n");
      continue;
    }
    EXPECT_LT(std::abs(off), kPrecision) << test::describeGains(settings);
    worst = std::max(worst, std::abs(off));
  }
  fmt::print("{} points, {} not decided, rate off by {:.5f} % at most\n", count, undecided,
             100.0 * worst);
  EXPECT_LE(undecided, count / 10);
}

}  // namespace
}  // namespace tandem
