#include "matrix/condition.h"

#include <array>
#include <cstdio>

namespace tandem::test {
namespace {

constexpr std::array kLoss{0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3};
constexpr std::array kDelay{0.0, 0.025, 0.05, 0.1, 0.15, 0.2, 0.3};  // [s]
constexpr std::array kJitter{0.0, 0.005, 0.02, 0.05};                // [s]
constexpr std::array kReorder{0.0, 0.01, 0.05};
constexpr std::array kDuplicate{0.0, 0.05, 0.25};
constexpr std::array kCorrupt{0.0, 0.001, 0.05, 0.2};
constexpr std::array kSlew{1e4, 2e3, 1e3};  // [N/s]
constexpr std::array kSchemes{"virtual_coupling", "kinematic_proxy", "remote_dynamic_proxy"};

struct Outage {
  double seconds;
  Cut cut;
};
constexpr std::array<Outage, 8> kOutages{{{0.0, Cut::kDrops},
                                          {0.05, Cut::kDrops},
                                          {0.25, Cut::kDrops},
                                          {1.0, Cut::kDrops},
                                          {5.0, Cut::kDrops},
                                          {0.25, Cut::kHoldsBack},
                                          {1.0, Cut::kHoldsBack},
                                          {5.0, Cut::kHoldsBack}}};

/// Indices of the factors in a row.
enum Factor : std::size_t {
  kLossFactor,
  kDelayFactor,
  kJitterFactor,
  kReorderFactor,
  kDuplicateFactor,
  kCorruptFactor,
  kOutageFactor,
  kSchemeFactor,
  kTaskFactor,
  kGuideFactor,
  kPlayoutFactor,
  kThinningFactor,
  kSlewFactor,
  kHandsFactor,
};

template <typename Values>
auto pick(const Values& values, int level) {
  return values[static_cast<std::size_t>(level)];
}

}  // namespace

std::vector<int> ConditionMatrix::levelCounts() {
  return {7, 7, 4, 3, 3, 4, 8, 3, 3, 2, 2, 2, 3, 2};
}

const ConditionMatrix& ConditionMatrix::instance() {
  static const ConditionMatrix matrix;
  return matrix;
}

ConditionMatrix::ConditionMatrix() {
  CoveringArray array(levelCounts(),
                      {{kSchemeFactor, 0, kTaskFactor, static_cast<int>(Task::kMeeting)}});
  rows_ = array.makeRows(kCells);
  pair_rows_ = array.pairRows();
}

Condition ConditionMatrix::at(std::size_t cell) const {
  const Levels& row = rows_.at(cell);
  Condition c;
  c.network.loss = pick(kLoss, row[kLossFactor]);
  c.network.delay = pick(kDelay, row[kDelayFactor]);
  c.network.jitter = pick(kJitter, row[kJitterFactor]);
  c.network.reorder = pick(kReorder, row[kReorderFactor]);
  c.network.duplicate = pick(kDuplicate, row[kDuplicateFactor]);
  c.corrupt = pick(kCorrupt, row[kCorruptFactor]);
  c.outage = pick(kOutages, row[kOutageFactor]).seconds;
  c.cut = pick(kOutages, row[kOutageFactor]).cut;
  c.scheme = pick(kSchemes, row[kSchemeFactor]);
  c.task = static_cast<Task>(row[kTaskFactor]);
  c.is_guided = row[kGuideFactor] == 0;
  c.has_playout = row[kPlayoutFactor] == 0;
  c.thins_when_idle = row[kThinningFactor] == 0;
  c.max_slew = pick(kSlew, row[kSlewFactor]);
  c.hands_shake = row[kHandsFactor] == 1;
  return c;
}

const char* nameOf(Task task) {
  switch (task) {
    case Task::kCooperation:
      return "cooperation";
    case Task::kFloating:
      return "floating";
    case Task::kMeeting:
      break;
  }
  return "meeting";
}

std::string describe(const Condition& c) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "%s %s%s%s%s%s, slew %g N/s, loss %g %%, delay %g ms, jitter %g ms, reorder %g %%, "
                "duplicate %g "
                "%%, corrupt %g %%, outage %g ms%s",
                c.scheme.c_str(), nameOf(c.task), c.is_guided ? ", guide" : "",
                c.has_playout ? ", playout" : "", c.thins_when_idle ? ", thinning" : "",
                c.hands_shake ? ", sine hands" : "", c.max_slew, 100.0 * c.network.loss,
                1e3 * c.network.delay, 1e3 * c.network.jitter, 100.0 * c.network.reorder,
                100.0 * c.network.duplicate, 100.0 * c.corrupt, 1e3 * c.outage,
                c.outage > 0.0 && c.cut == Cut::kHoldsBack ? " held back" : "");
  return text.data();
}

}  // namespace tandem::test
