#pragma once

#include <cstddef>
#include <vector>

#include "island/six.h"

namespace tandem {

/// Symmetric positive definite matrix of blocks in an envelope, with its Cholesky factor.
///
/// Rows come in panels of one to six. Panel i has blocks from its first column panel to the
/// diagonal. Elimination fills nothing outside, so a chain costs linearly. Blocks are 6 x 6, with
/// zeros beyond the rows of their panels. After the constructor nothing allocates.
class PanelMatrix {
 public:
  PanelMatrix(std::size_t max_panels, std::size_t max_blocks);

  void clear() noexcept;
  [[nodiscard]] std::size_t size() const noexcept { return panels_.size(); }
  [[nodiscard]] bool hasRoomFor(std::size_t first) const noexcept {
    return size() < panels_.capacity() && blocks_.size() + size() - first < blocks_.capacity();
  }
  /// Adds a panel of `count` rows; returns its zero blocks from column panel `first` to the
  /// diagonal, to be set. They are valid until the next call.
  [[nodiscard]] SixBySix* addPanel(int count, std::size_t first) noexcept;

  /// Replaces the matrix by its factor L with M = L L^T. False if it is not positive definite.
  [[nodiscard]] bool factorise() noexcept;
  /// Solves for one right side in place, by panel.
  void solve(std::vector<Six>& x) const noexcept;

 private:
  struct Panel {
    int count;
    std::size_t first, start;  ///< first column panel, and the place of its block
    Six inverse_diagonal;
  };

  [[nodiscard]] static bool factorise(SixBySix& block, Panel& panel) noexcept;
  static void subtractProduct(const SixBySix& a, int inner, const SixBySix& b, int count,
                              SixBySix& out) noexcept;
  static void divide(const SixBySix& factor, const Panel& before, SixBySix& block) noexcept;
  /// Block of row panel i and column panel j.
  [[nodiscard]] SixBySix& block(std::size_t i, std::size_t j) noexcept {
    return blocks_[panels_[i].start + j - panels_[i].first];
  }
  [[nodiscard]] const SixBySix& block(std::size_t i, std::size_t j) const noexcept {
    return blocks_[panels_[i].start + j - panels_[i].first];
  }

  std::vector<Panel> panels_;
  std::vector<SixBySix> blocks_;
};

}  // namespace tandem
