// Every pair of network conditions occurs in a cell of the matrix. In each cell two sites go live,
// work together, are cut off from each other for a while, and recover.
//
// The default cells contain every pair. More and others:
//
//   TANDEM_MATRIX_CELLS=150 TANDEM_MATRIX_SEEDS=3    how much is run
//   TANDEM_MATRIX_CELL=17:2                          cell 17 with seed 2, alone

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include <gtest/gtest.h>

#include "matrix/matrix_scene.h"

namespace tandem {
namespace {

using test::CellReport;
using test::Condition;
using test::ConditionMatrix;
using test::MatrixScene;
using test::SiteReport;
using test::Task;

/// Most energy that a hand may get with an empty tank [J]. It still moves in the tick that holds
/// the force.
constexpr double kOverdraft = 1e-4;
/// Most energy that both hands may get beyond their input [J]: two tanks.
constexpr double kMostGiven = 2.0 * PassivitySettings{}.tank + 1e-6;

constexpr double kTick = MatrixScene::kPeriod;

/// Faults of a cell; empty if it passed.
class Faults {
 public:
  void expect(bool is_good, const char* what, double value, double limit) {
    if (is_good) return;
    text_ << (text_.tellp() > 0 ? "; " : "") << what << " " << value << " (limit " << limit << ")";
  }
  void expectAtMost(const char* what, double value, double limit) {
    expect(value <= limit, what, value, limit);
  }
  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

void checkSite(const Condition& c, const SiteReport& site, Faults& faults) {
  const double way = c.slowest() + 0.05, grace = MatrixScene::kGrace;
  faults.expect(site.is_finite, "not finite", 0, 0);
  faults.expect(site.status == kTickOk, "tick status", site.status, 0);
  faults.expectAtMost("force [N]", site.largest_force, MatrixScene::kMaxForce * (1.0 + 1e-12));
  faults.expectAtMost("rise of the force [N]", site.largest_rise,
                      c.max_slew * MatrixScene::kPeriod * (1.0 + 1e-12));
  faults.expectAtMost("energy got when none was left [J]", site.overdrawn, kOverdraft);
  faults.expectAtMost("age beyond delay and playout [s]", site.largest_excess, grace + 2.0 * kTick);
  faults.expect(site.phase == PeerPhase::kLive, "phase", static_cast<double>(site.phase), 3);
  faults.expectAtMost("silence at the end [s]", site.last_taken, grace);
  faults.expect(site.last_coupled >= 0.0 && site.last_coupled <= 1.0, "coupled before the end [s]",
                site.last_coupled, 1.0);
  faults.expect(site.first_new >= 0.0 && site.first_new <= way + grace + kTick,
                "first state after the outage [s]", site.first_new, way + grace);
  if (c.keepsOrder()) faults.expect(site.live_again >= 0.0, "never live again", 0, 0);
  const double recovery = 2.0 * way + grace;
  faults.expect(site.recovered >= 0.0 && site.recovered <= recovery, "recovery [s]", site.recovered,
                recovery);
}

std::string findFaults(const Condition& c, const CellReport& report) {
  Faults faults;
  faults.expect(report.joined >= 0.0, "joined [s]", report.joined, MatrixScene::kPatience);
  faults.expectAtMost("energy given to both hands [J]", -report.least_energy, kMostGiven);
  for (const SiteReport& site : report.sites) checkSite(c, site, faults);
  return faults.text();
}

std::string format(const char* form, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), form, value);
  return text.data();
}

/// The worst value of some cells, with its cell.
struct Worst {
  double value = 0.0;
  std::string cell;
  void add(double v, const std::string& where) {
    if (!cell.empty() && v <= value) return;
    value = v;
    cell = where;
  }
  [[nodiscard]] std::string text(double unit, const char* form) const {
    return cell.empty() ? "-" : format(form, unit * value) + " (" + cell + ")";
  }
};

struct Summary {
  int runs = 0, failed = 0;
  Worst joined, force, step, energy, overdrawn, limited, age, first_new, recovered, live_again;

  void add(const CellReport& report, const std::string& where) {
    ++runs;
    joined.add(report.joined, where);
    energy.add(-report.least_energy, where);
    for (const SiteReport& site : report.sites) {
      force.add(site.largest_force, where);
      step.add(site.largest_rise, where);
      overdrawn.add(site.overdrawn, where);
      limited.add(static_cast<double>(site.counters.energy_limited), where);
      age.add(site.largest_excess, where);
      first_new.add(site.first_new, where);
      recovered.add(site.recovered, where);
      live_again.add(site.live_again, where);
    }
  }
  void print(const char* title) const {
    std::printf(
        "%s: %d runs, %d failed; joined %s s; force %s N; rise %s N; energy %s mJ, got when "
        "none was left %s mJ, limited in %s ticks; age beyond delay and playout %s ms; after the "
        "outage: "
        "first state %s ms, rejoining %s ms, live %s ms\n",
        title, runs, failed, joined.text(1, "%.2f").c_str(), force.text(1, "%.2f").c_str(),
        step.text(1, "%.2f").c_str(), energy.text(-1e3, "%.3f").c_str(),
        overdrawn.text(1e3, "%.3f").c_str(), limited.text(1, "%.0f").c_str(),
        age.text(1e3, "%.0f").c_str(), first_new.text(1e3, "%.0f").c_str(),
        recovered.text(1e3, "%.0f").c_str(), live_again.text(1e3, "%.0f").c_str());
  }
};

struct Part {
  const char* scheme;
  Task task;
};

std::string nameOf(const Part& part) {
  return std::string(part.scheme) + "_" + test::nameOf(part.task);
}

class ConditionMatrixTest : public ::testing::TestWithParam<Part> {
 protected:
  void runCell(std::size_t cell, std::uint64_t seed) {
    const Condition condition = ConditionMatrix::instance().at(cell);
    if (condition.scheme != GetParam().scheme || condition.task != GetParam().task) return;
    const std::string where = std::to_string(cell) + ":" + std::to_string(seed);
    MatrixScene scene(condition, seed);
    const CellReport report = scene.run();
    const std::string faults = findFaults(condition, report);
    summary_.failed += faults.empty() ? 0 : 1;
    summary_.add(report, where);
    EXPECT_TRUE(faults.empty()) << "TANDEM_MATRIX_CELL=" << where << ": " << faults << " ["
                                << describe(condition) << "]";
  }

  Summary summary_;
};

TEST_P(ConditionMatrixTest, SitesStayCalmAndComeBack) {
  const ConditionMatrix& matrix = ConditionMatrix::instance();
  const std::size_t cells = matrix.rows().size();
  if (const char* one = std::getenv("TANDEM_MATRIX_CELL")) {
    const char* colon = std::strchr(one, ':');
    const std::size_t cell = std::strtoull(one, nullptr, 10);
    ASSERT_LT(cell, cells);
    runCell(cell, colon ? std::strtoull(colon + 1, nullptr, 10) : 1);
  } else {
    const std::size_t count =
        std::min(cells, test::readCount("TANDEM_MATRIX_CELLS", matrix.pairRows()));
    const std::uint64_t seeds = test::readCount("TANDEM_MATRIX_SEEDS", 1);
    for (std::size_t cell = 0; cell < count; ++cell)
      for (std::uint64_t seed = 1; seed <= seeds; ++seed) runCell(cell, seed);
  }
  if (summary_.runs > 0) summary_.print(nameOf(GetParam()).c_str());
}

std::vector<Part> allParts() {
  std::vector<Part> all;
  for (const char* scheme : {"virtual_coupling", "kinematic_proxy", "remote_dynamic_proxy"})
    for (const Task task : {Task::kCooperation, Task::kFloating, Task::kMeeting})
      if (task != Task::kMeeting || std::string(scheme) != "virtual_coupling")
        all.push_back({scheme, task});
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, ConditionMatrixTest, ::testing::ValuesIn(allParts()),
                         [](const auto& part) { return nameOf(part.param); });

// Keys are drawn anew each time. No felt quantity depends on them.
TEST(MatrixScene, IsEqualToTheBitEachTime) {
  const Condition condition = ConditionMatrix::instance().at(0);
  MatrixScene first(condition, 1), second(condition, 1), other(condition, 2);
  const std::uint64_t hash = first.run().hash;
  EXPECT_EQ(hash, second.run().hash);
  EXPECT_NE(hash, other.run().hash);
}

}  // namespace
}  // namespace tandem
