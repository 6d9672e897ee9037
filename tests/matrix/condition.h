#pragma once

#include <string>
#include <vector>

#include "tandem/coordination/impairments.h"

#include "matrix/covering_array.h"

namespace tandem::test {

/// Task of the users: Experiments I and II of docs/paper.md, stroke by stroke. The first user's
/// hand follows its own path, the second user's is pushed.
enum class Task {
  kCooperation,  ///< the users hold a damped cube from both sides
  kFloating,     ///< the same with an undamped cube: cut off, its copies fly apart
  kMeeting,      ///< the users touch each other
};
[[nodiscard]] const char* nameOf(Task task);

/// Treatment of datagrams that are sent during a cut.
enum class Cut { kDrops, kHoldsBack };

/// One cell of the matrix.
struct Condition {
  Impairments network;   ///< without a seed
  double corrupt = 0.0;  ///< probability that a copy has a bit flipped
  double outage = 0.0;   ///< length of the cut [s]; 0: none
  Cut cut = Cut::kDrops;
  std::string scheme;
  Task task = Task::kCooperation;
  double max_slew = 1e4;     ///< of both sites [N/s]
  bool hands_shake = false;  ///< both hands push by sines at once; else one makes strokes
  bool is_guided = true, has_playout = true, thins_when_idle = true;

  /// True if states come out in the order of sending, with few late. Without playout one that
  /// overtakes makes all before it worthless, and silence lasts as long as the delay.
  [[nodiscard]] bool keepsOrder() const { return has_playout || network.reorder == 0.0; }
  /// Largest one-way time [s].
  [[nodiscard]] double slowest() const { return network.delay + network.jitter; }
};

/// Describes a condition in one line, as in reports.
[[nodiscard]] std::string describe(const Condition& condition);

/// All cells of the matrix: first those for all pairs, then for triples.
class ConditionMatrix {
 public:
  static constexpr std::size_t kCells = 150;

  [[nodiscard]] static const ConditionMatrix& instance();
  [[nodiscard]] static std::vector<int> levelCounts();

  [[nodiscard]] const std::vector<Levels>& rows() const { return rows_; }
  [[nodiscard]] std::size_t pairRows() const { return pair_rows_; }
  [[nodiscard]] Condition at(std::size_t cell) const;

 private:
  ConditionMatrix();

  std::vector<Levels> rows_;
  std::size_t pair_rows_ = 0;
};

}  // namespace tandem::test
