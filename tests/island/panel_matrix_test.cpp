// Cholesky factors of a symmetric matrix of panels, against Eigen's dense solver.
#include "coordination/src/island/panel_matrix.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

/// L L^T of a drawn factor with panels of one to six rows in an envelope.
struct Drawn {
  std::vector<int> counts, starts, firsts;
  Eigen::MatrixXd dense;

  Drawn(test::Random& random, int size) {
    int rows = 0;
    for (int i = 0; i < size; ++i) {
      firsts.push_back(random.below(i + 1));
      counts.push_back(1 + random.below(6));
      starts.push_back(rows);
      rows += counts.back();
    }
    Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(rows, rows);
    visit([&](int row, int column) {
      if (column < row) factor(row, column) = random.uniform(-1.0, 1.0);
      if (column == row) factor(row, column) = random.uniform(1.0, 2.0);
    });
    dense = factor * factor.transpose();
  }

  /// Calls visit(row, column) for each entry of each block in the envelope.
  template <typename Visit>
  void visit(Visit visit) const {
    for (int i = 0; i < size(); ++i)
      for (int j = at(firsts, i); j <= i; ++j)
        for (int r = 0; r < at(counts, i); ++r)
          for (int c = 0; c < at(counts, j); ++c) visit(at(starts, i) + r, at(starts, j) + c);
  }
  void fill(PanelMatrix& matrix) const {
    matrix.clear();
    for (int i = 0; i < size(); ++i) {
      const auto first = static_cast<std::size_t>(at(firsts, i));
      ASSERT_TRUE(matrix.hasRoomFor(first));
      SixBySix* const blocks = matrix.addPanel(at(counts, i), first);
      for (int j = at(firsts, i); j <= i; ++j)
        for (int r = 0; r < at(counts, i); ++r)
          for (int c = 0; c < at(counts, j); ++c)
            blocks[j - at(firsts, i)].column[c].at[r] = dense(at(starts, i) + r, at(starts, j) + c);
    }
  }
  [[nodiscard]] int size() const { return static_cast<int>(counts.size()); }
  [[nodiscard]] static int at(const std::vector<int>& list, int i) {
    return list[static_cast<std::size_t>(i)];
  }
};

TEST(PanelMatrix, SolvesLikeADenseMatrix) {
  constexpr std::uint64_t kSeed = 20261127;
  RecordProperty("seed", std::to_string(kSeed));
  test::Random random(kSeed);
  PanelMatrix matrix(12, 200);
  for (int run = 0; run < 200; ++run) {
    const int size = 1 + random.below(12);
    const Drawn drawn(random, size);
    drawn.fill(matrix);
    ASSERT_TRUE(matrix.factorise());
    Eigen::VectorXd right(drawn.dense.rows());
    for (double& value : right) value = random.uniform(-1.0, 1.0);
    std::vector<Six> x(static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i)
      for (int r = 0; r < Drawn::at(drawn.counts, i); ++r)
        x[static_cast<std::size_t>(i)].at[r] = right[Drawn::at(drawn.starts, i) + r];
    matrix.solve(x);
    const Eigen::VectorXd expected = drawn.dense.ldlt().solve(right);
    for (int i = 0; i < size; ++i)
      for (int r = 0; r < 6; ++r) {
        const double wanted =
            r < Drawn::at(drawn.counts, i) ? expected[Drawn::at(drawn.starts, i) + r] : 0.0;
        EXPECT_NEAR(x[static_cast<std::size_t>(i)].at[r], wanted, 1e-10 * expected.norm())
            << "seed " << kSeed << " run " << run << " panel " << i;
      }
  }
}

TEST(PanelMatrix, TellsThatAMatrixIsNotPositiveDefinite) {
  PanelMatrix matrix(2, 3);
  for (const double pivot : {1.0, 0.0, -1.0, HUGE_VAL, std::nan("")}) {
    matrix.clear();
    matrix.addPanel(1, 0)->column[0].at[0] = 1.0;
    SixBySix* const blocks = matrix.addPanel(2, 0);
    blocks[1].column[0].at[0] = 1.0;
    blocks[1].column[1].at[1] = pivot;
    EXPECT_EQ(matrix.factorise(), pivot == 1.0) << pivot;
  }
}

TEST(PanelMatrix, HasNoRoomForMoreThanItWasMadeFor) {
  PanelMatrix matrix(2, 2);
  EXPECT_TRUE(matrix.hasRoomFor(0));
  static_cast<void>(matrix.addPanel(6, 0));
  EXPECT_TRUE(matrix.hasRoomFor(1));
  EXPECT_FALSE(matrix.hasRoomFor(0));
}

}  // namespace
}  // namespace tandem
