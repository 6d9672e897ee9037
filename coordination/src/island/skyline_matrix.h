#pragma once

#include <cstddef>
#include <vector>

namespace tandem {

/// Symmetric positive definite matrix in a skyline, with its Cholesky factor.
///
/// Row i has entries from its first column to the diagonal. Elimination fills nothing outside, so a
/// chain costs linearly. After the constructor nothing allocates.
class SkylineMatrix {
 public:
  SkylineMatrix(std::size_t max_rows, std::size_t max_entries);

  void clear() noexcept;
  [[nodiscard]] std::size_t size() const noexcept { return starts_.size(); }
  [[nodiscard]] bool hasRoomFor(std::size_t first) const noexcept {
    return size() < starts_.capacity() && entries_.size() + size() - first < entries_.capacity();
  }
  /// Adds a row; returns its entries from column `first` to the diagonal, to be set.
  [[nodiscard]] double* addRow(std::size_t first) noexcept;

  /// Replaces the matrix by its factor L with M = L L^T. False if it is not positive definite.
  [[nodiscard]] bool factorise() noexcept;
  /// Solves for one right side in place.
  void solve(std::vector<double>& x) const noexcept;

 private:
  [[nodiscard]] const double* row(std::size_t i) const noexcept { return &entries_[starts_[i]]; }

  std::vector<std::size_t> firsts_, starts_;  ///< by row: first column, and its place in entries_
  std::vector<double> entries_;
  std::vector<double> inverse_diagonal_;
};

}  // namespace tandem
