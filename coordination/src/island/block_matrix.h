#pragma once

#include <cstddef>
#include <vector>

#include "island/six.h"

namespace tandem {

/// Square matrix of 6 x 6 blocks inside an envelope, with its LU factors.
///
/// Row i has blocks from its first column first[i] to the diagonal, and column i has blocks in the
/// same places. Elimination fills nothing outside, so a row of bodies costs linearly. There is no
/// pivoting. After the constructor nothing allocates.
class BlockMatrix {
 public:
  /// Room for `max_rows` block rows, and `max_blocks` blocks below the diagonal.
  BlockMatrix(std::size_t max_rows, std::size_t max_blocks);

  /// Number of blocks below the diagonal that an envelope needs.
  [[nodiscard]] static std::size_t countBlocks(const std::vector<int>& first) noexcept;
  /// True if there is room for such an envelope.
  [[nodiscard]] bool hasRoomFor(const std::vector<int>& first) const noexcept;

  /// Becomes the identity with room for blocks within the envelope; first[i] <= i.
  void setIdentity(const std::vector<int>& first) noexcept;
  [[nodiscard]] SixBySix& diagonal(int i) noexcept {
    return diagonal_[static_cast<std::size_t>(i)];
  }
  /// Block in row i and column j < i.
  [[nodiscard]] SixBySix& lower(int i, int j) noexcept { return lower_[place(i, j)]; }
  /// Block in row j and column i > j.
  [[nodiscard]] SixBySix& upper(int j, int i) noexcept { return upper_[place(i, j)]; }

  /// Replaces the matrix by its factors. False if a pivot is 0, or the result not finite.
  [[nodiscard]] bool factorise() noexcept;
  /// Solves for one right side in place.
  void solve(std::vector<Six>& x) const noexcept;

 private:
  [[nodiscard]] std::size_t place(int i, int j) const noexcept {
    return start_[static_cast<std::size_t>(i)] +
           static_cast<std::size_t>(j - first_[static_cast<std::size_t>(i)]);
  }

  std::vector<int> first_;          ///< by row
  std::vector<std::size_t> start_;  ///< by row: place of its first block in lower_
  std::vector<SixBySix> diagonal_;  ///< factorised: the inverse
  std::vector<SixBySix> lower_, upper_;
};

}  // namespace tandem
