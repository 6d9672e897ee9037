#pragma once

#include <string>
#include <vector>

#include "tandem/coordination/impairments.h"

#include "matrix/covering_array.h"

namespace tandem::test {

/// What the users do: Experiments I and II of docs/paper.md, stroke by stroke. The first user's
/// hand goes its way, the second's is pushed.
enum class Task {
  kCooperation,  ///< on both sides of a cube that something slows down
  kFloating,     ///< the same with a cube that nothing slows down: cut off, its copies fly apart
  kMeeting,      ///< the users touch each other
};
[[nodiscard]] const char* nameOf(Task task);

/// What a network that is cut does with what is sent meanwhile.
enum class Cut { kDrops, kHoldsBack };

/// One cell of the matrix.
struct Condition {
  Impairments network;   ///< without a seed
  double corrupt = 0.0;  ///< probability that a copy has a bit turned
  double outage = 0.0;   ///< [s]; 0: none
  Cut cut = Cut::kDrops;
  std::string scheme;
  Task task = Task::kCooperation;
  bool is_guided = true, has_playout = true, thins_when_idle = true;

  /// States come out in the order in which they were sent, at most a few late. Without playout one
  /// that jumps the queue makes those before it worthless, and silence lasts as long as the way.
  [[nodiscard]] bool keepsOrder() const { return has_playout || network.reorder == 0.0; }
  /// One way, at most [s].
  [[nodiscard]] double slowest() const { return network.delay + network.jitter; }
};

/// In one line, as reports have it.
[[nodiscard]] std::string describe(const Condition& condition);

/// All cells: pairs first, then triples.
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
