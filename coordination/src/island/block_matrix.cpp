#include "island/block_matrix.h"

#include <algorithm>

namespace tandem {

BlockMatrix::BlockMatrix(std::size_t max_rows, std::size_t max_blocks) {
  first_.reserve(max_rows);
  start_.reserve(max_rows);
  diagonal_.reserve(max_rows);
  lower_.reserve(max_blocks);
  upper_.reserve(max_blocks);
}

std::size_t BlockMatrix::countBlocks(const std::vector<int>& first) noexcept {
  std::size_t count = 0;
  for (std::size_t i = 0; i < first.size(); ++i) count += i - static_cast<std::size_t>(first[i]);
  return count;
}

bool BlockMatrix::hasRoomFor(const std::vector<int>& first) const noexcept {
  return first.size() <= first_.capacity() && countBlocks(first) <= lower_.capacity();
}

void BlockMatrix::setIdentity(const std::vector<int>& first) noexcept {
  first_.assign(first.begin(), first.end());
  start_.clear();
  std::size_t count = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    start_.push_back(count);
    count += i - static_cast<std::size_t>(first[i]);
  }
  diagonal_.resize(first.size());
  for (SixBySix& block : diagonal_) block.setIdentity();
  lower_.assign(count, SixBySix());
  upper_.assign(count, SixBySix());
}

bool BlockMatrix::factorise() noexcept {
  const int size = static_cast<int>(first_.size());
  for (int i = 0; i < size; ++i) {
    const int first_i = first_[static_cast<std::size_t>(i)];
    SixBySix& pivot = diagonal(i);
    for (int j = first_i; j < i; ++j) {
      SixBySix& below = lower(i, j);
      SixBySix& right = upper(j, i);
      for (int k = std::max(first_i, first_[static_cast<std::size_t>(j)]); k < j; ++k) {
        below.subtractProduct(lower(i, k), upper(k, j));
        right.subtractProduct(lower(j, k), upper(k, i));
      }
      const SixBySix raw = below;
      below.setZero();
      below.addProduct(raw, diagonal(j));
      pivot.subtractProduct(below, right);
    }
    if (!pivot.invert()) return false;
  }
  return true;
}

void BlockMatrix::solve(std::vector<Six>& x) const noexcept {
  const int size = static_cast<int>(first_.size());
  for (int i = 0; i < size; ++i)
    for (int j = first_[static_cast<std::size_t>(i)]; j < i; ++j)
      lower_[place(i, j)].subtractFrom(x[static_cast<std::size_t>(i)],
                                       x[static_cast<std::size_t>(j)]);
  for (int i = size - 1; i >= 0; --i) {
    Six& part = x[static_cast<std::size_t>(i)];
    const Six raw = part;
    part.setZero();
    diagonal_[static_cast<std::size_t>(i)].addTo(part, raw);
    for (int j = first_[static_cast<std::size_t>(i)]; j < i; ++j)
      upper_[place(i, j)].subtractFrom(x[static_cast<std::size_t>(j)], part);
  }
}

}  // namespace tandem
