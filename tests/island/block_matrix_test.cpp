// LU factors of a matrix of 6 x 6 blocks inside an envelope, against Eigen's dense solver.
#include "coordination/src/island/block_matrix.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

constexpr int kBlock = 6;
using Block = Eigen::Matrix<double, kBlock, kBlock>;
using Part = Eigen::Matrix<double, kBlock, 1>;

Six toSix(const Part& part) {
  Six six;
  Part::Map(six.at) = part;
  return six;
}
Part toPart(const Six& six) { return Part::Map(six.at); }

/// The same matrix as blocks and dense.
struct Pair {
  BlockMatrix blocks;
  Eigen::MatrixXd dense;

  explicit Pair(const std::vector<int>& first)
      : blocks(first.size(), BlockMatrix::countBlocks(first)),
        dense(Eigen::MatrixXd::Identity(size(first), size(first))) {
    blocks.setIdentity(first);
  }
  static int size(const std::vector<int>& first) { return kBlock * static_cast<int>(first.size()); }

  /// Adds a block in row i and column j.
  void add(int i, int j, const Block& block) {
    SixBySix& to = i == j ? blocks.diagonal(i) : i > j ? blocks.lower(i, j) : blocks.upper(i, j);
    for (int c = 0; c < kBlock; ++c) to.column[c].add(toSix(block.col(c)));
    dense.block<kBlock, kBlock>(kBlock * i, kBlock * j) += block;
  }
};

Block makeBlock(test::Random& random) {
  Block block;
  for (double& value : block.reshaped()) value = random.uniform(-1.0, 1.0);
  return block;
}

/// Fills the envelope; the diagonal outweighs the rest, as mass and stiffness do.
Pair makePair(const std::vector<int>& first, test::Random& random) {
  Pair pair(first);
  const int size = static_cast<int>(first.size());
  for (int i = 0; i < size; ++i) {
    pair.add(i, i, makeBlock(random) + 2.0 * kBlock * size * Block::Identity());
    for (int j = first[static_cast<std::size_t>(i)]; j < i; ++j) {
      pair.add(i, j, makeBlock(random));
      pair.add(j, i, makeBlock(random));
    }
  }
  return pair;
}

TEST(BlockMatrix, SolvesRandomEnvelopesLikeADenseMatrix) {
  constexpr std::uint64_t kSeed = 20261125;
  RecordProperty("seed", std::to_string(kSeed));
  test::Random random(kSeed);
  for (int run = 0; run < 100; ++run) {
    std::vector<int> first;
    const int size = 1 + random.below(12);
    for (int i = 0; i < size; ++i) first.push_back(random.below(i + 1));
    Pair pair = makePair(first, random);
    Eigen::VectorXd right(Pair::size(first));
    for (double& value : right) value = random.uniform(-1.0, 1.0);
    std::vector<Six> x;
    for (int i = 0; i < size; ++i) x.push_back(toSix(right.segment<kBlock>(kBlock * i)));
    ASSERT_TRUE(pair.blocks.hasRoomFor(first));
    ASSERT_TRUE(pair.blocks.factorise());
    pair.blocks.solve(x);
    const Eigen::VectorXd expected = pair.dense.partialPivLu().solve(right);
    for (int i = 0; i < size; ++i)
      // Rounding of a well conditioned matrix is far below this.
      EXPECT_LT(
          (toPart(x[static_cast<std::size_t>(i)]) - expected.segment<kBlock>(kBlock * i)).norm(),
          1e-10 * expected.norm())
          << "seed " << kSeed << " run " << run << " block " << i;
  }
}

// A penalty of 1e4 times the mass, in directions that no mass balances, as contacts have it. Stored
// inverses lose the condition (1e5) twice: 1e-16 becomes 1e-6. ContactSolver measures its residual
// anew after each solve, so a second one is exact.
TEST(BlockMatrix, SolvesARowOfStiffContactsInTwoRounds) {
  test::Random random(7);
  constexpr int kSize = 16;
  constexpr double kStiffness = 1e4;
  std::vector<int> first{0};
  for (int i = 1; i < kSize; ++i) first.push_back(i - 1);
  Pair pair(first);
  for (int i = 1; i < kSize; ++i) {
    const Eigen::Matrix<double, 3, 6> J_a = makeBlock(random).topRows<3>();
    const Eigen::Matrix<double, 3, 6> J_b = makeBlock(random).topRows<3>();
    pair.add(i, i, kStiffness * J_a.transpose() * J_a);
    pair.add(i - 1, i - 1, kStiffness * J_b.transpose() * J_b);
    pair.add(i, i - 1, kStiffness * J_a.transpose() * J_b);
    pair.add(i - 1, i, kStiffness * J_b.transpose() * J_a);
  }
  ASSERT_TRUE(pair.blocks.factorise());
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(kBlock * kSize);
  const Eigen::VectorXd expected = pair.dense.partialPivLu().solve(ones);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(kBlock * kSize);
  for (const double tolerance : {1e-6, 1e-10}) {
    const Eigen::VectorXd residual = ones - pair.dense * x;
    std::vector<Six> change;
    for (int i = 0; i < kSize; ++i) change.push_back(toSix(residual.segment<kBlock>(kBlock * i)));
    pair.blocks.solve(change);
    for (int i = 0; i < kSize; ++i)
      x.segment<kBlock>(kBlock * i) += toPart(change[static_cast<std::size_t>(i)]);
    EXPECT_LT((x - expected).norm(), tolerance * expected.norm());
  }
}

TEST(BlockMatrix, TellsThatAMatrixIsSingular) {
  test::Random random(3);
  for (const int at : {0, 1, 2}) {
    Pair pair = makePair({0, 0, 1}, random);
    // Its row and column of blocks are zero.
    pair.blocks.diagonal(at).setZero();
    for (int j = at == 2 ? 1 : 0; j < at; ++j) {
      pair.blocks.lower(at, j).setZero();
      pair.blocks.upper(j, at).setZero();
    }
    if (at < 2) {
      pair.blocks.lower(at + 1, at).setZero();
      pair.blocks.upper(at, at + 1).setZero();
    }
    EXPECT_FALSE(pair.blocks.factorise()) << "block " << at;
  }
}

TEST(BlockMatrix, TellsThatAMatrixIsNotFinite) {
  Pair pair({0, 0});
  pair.blocks.lower(1, 0).column[3].at[2] = std::nan("");
  EXPECT_FALSE(pair.blocks.factorise());
}

TEST(BlockMatrix, HasRoomForItsEnvelopeOnly) {
  const BlockMatrix matrix(3, 2);
  EXPECT_TRUE(matrix.hasRoomFor({0, 0, 1}));
  EXPECT_FALSE(matrix.hasRoomFor({0, 0, 0}));
  EXPECT_FALSE(matrix.hasRoomFor({0, 1, 2, 3}));
}

}  // namespace
}  // namespace tandem
