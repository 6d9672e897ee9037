#include "matrix/covering_array.h"

#include <gtest/gtest.h>

#include "matrix/condition.h"

namespace tandem {
namespace {

using test::CoveringArray;
using test::Levels;

bool meet(const std::vector<Levels>& rows, std::size_t f, int level, std::size_t g, int other) {
  return std::any_of(rows.begin(), rows.end(),
                     [&](const Levels& row) { return row[f] == level && row[g] == other; });
}

TEST(CoveringArray, EveryPairThatIsNotExcludedIsThere) {
  const std::vector<int> counts{7, 7, 4, 3, 2, 2};
  CoveringArray array(counts, {{0, 1, 4, 1}, {2, 3, 5, 0}});
  const std::vector<Levels> rows = array.makeRows(0);
  EXPECT_EQ(rows.size(), array.pairRows());
  for (std::size_t f = 0; f < counts.size(); ++f)
    for (std::size_t g = f + 1; g < counts.size(); ++g)
      for (int level = 0; level < counts[f]; ++level)
        for (int other = 0; other < counts[g]; ++other)
          EXPECT_EQ(meet(rows, f, level, g, other), !array.isExcluded(f, level, g, other));
  // At least 49 rows are needed. One row for each combination would be 2352.
  EXPECT_LT(rows.size(), 70u);
}

TEST(CoveringArray, RowsAreTheSameEachTimeAndMoreBeginAlike) {
  CoveringArray first({5, 4, 3, 3}, {}), second({5, 4, 3, 3}, {});
  const auto few = first.makeRows(25), many = second.makeRows(40);
  ASSERT_EQ(few.size(), 25u);
  ASSERT_EQ(many.size(), 40u);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
}

TEST(CoveringArray, FurtherRowsCoverTriples) {
  CoveringArray array({3, 3, 2, 2}, {});
  std::vector<bool> seen(18);
  for (const Levels& row : array.makeRows(30))
    seen[static_cast<std::size_t>(6 * row[0] + 2 * row[1] + row[3])] = true;
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 18);
}

TEST(CoveringArray, TheMatrixHasEveryPairOfConditions) {
  const test::ConditionMatrix& matrix = test::ConditionMatrix::instance();
  EXPECT_GE(matrix.rows().size(), 150u);
  EXPECT_LT(matrix.pairRows(), 90u);
  const std::vector<int> counts = test::ConditionMatrix::levelCounts();
  int missing = 0;
  for (std::size_t f = 0; f < counts.size(); ++f)
    for (std::size_t g = f + 1; g < counts.size(); ++g)
      for (int level = 0; level < counts[f]; ++level)
        for (int other = 0; other < counts[g]; ++other)
          missing += meet(matrix.rows(), f, level, g, other) ? 0 : 1;
  EXPECT_EQ(missing, 1);  // with virtual coupling users feel each other only through an object
}

}  // namespace
}  // namespace tandem
