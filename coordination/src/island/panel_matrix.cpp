#include "island/panel_matrix.h"

#include <algorithm>
#include <cmath>

namespace tandem {

PanelMatrix::PanelMatrix(std::size_t max_panels, std::size_t max_blocks) {
  panels_.reserve(max_panels);
  blocks_.reserve(max_blocks);
}

void PanelMatrix::clear() noexcept {
  panels_.clear();
  blocks_.clear();
}

SixBySix* PanelMatrix::addPanel(int count, std::size_t first) noexcept {
  panels_.push_back({count, first, blocks_.size(), {}});
  blocks_.resize(blocks_.size() + size() - first);
  return &blocks_[panels_.back().start];
}

bool PanelMatrix::factorise() noexcept {
  for (std::size_t i = 0; i < size(); ++i) {
    const Panel& panel = panels_[i];
    SixBySix& diagonal = block(i, i);
    for (std::size_t j = panel.first; j < i; ++j) {
      const Panel& before = panels_[j];
      SixBySix& off = block(i, j);
      for (std::size_t k = std::max(panel.first, before.first); k < j; ++k)
        subtractProduct(block(i, k), panels_[k].count, block(j, k), before.count, off);
      divide(block(j, j), before, off);
      subtractProduct(off, before.count, off, panel.count, diagonal);
    }
    if (!factorise(diagonal, panels_[i])) return false;
  }
  return true;
}

/// out -= a b^T, where a and b have `inner` columns, and b has `count` rows.
void PanelMatrix::subtractProduct(const SixBySix& a, int inner, const SixBySix& b, int count,
                                  SixBySix& out) noexcept {
  for (int c = 0; c < count; ++c) {
    Six column = out.column[c];
    for (int m = 0; m < inner; ++m) column.addScaled(-b.column[m].at[c], a.column[m]);
    out.column[c] = column;
  }
}

/// Multiplies by the inverse of the transposed factor of a panel before.
void PanelMatrix::divide(const SixBySix& factor, const Panel& before, SixBySix& block) noexcept {
  for (int c = 0; c < before.count; ++c) {
    Six column = block.column[c];
    for (int m = 0; m < c; ++m) column.addScaled(-factor.column[m].at[c], block.column[m]);
    block.column[c] = column.scaled(before.inverse_diagonal.at[c]);
  }
}

/// Writes zeros above the diagonal, so that columns can be taken whole.
bool PanelMatrix::factorise(SixBySix& block, Panel& panel) noexcept {
  for (int c = 0; c < panel.count; ++c) {
    const double pivot = block.column[c].at[c];
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    const double inverse = 1.0 / std::sqrt(pivot);
    panel.inverse_diagonal.at[c] = inverse;
    const Six column = block.column[c].scaled(inverse);
    for (int next = c + 1; next < panel.count; ++next)
      block.column[next].addScaled(-column.at[next], column);
    block.column[c] = column;
  }
  for (int c = 1; c < panel.count; ++c)
    for (int r = 0; r < c; ++r) block.column[c].at[r] = 0.0;
  return true;
}

// A pair that was just written by halves stalls the processor: sums are pairs, results are not.
void PanelMatrix::solve(std::vector<Six>& x) const noexcept {
  for (std::size_t i = 0; i < size(); ++i) {
    const Panel& panel = panels_[i];
    Six rest = x[i];
    for (std::size_t j = panel.first; j < i; ++j)
      for (int c = 0; c < panels_[j].count; ++c) rest.addScaled(-x[j].at[c], block(i, j).column[c]);
    for (int c = 0; c < panel.count; ++c) {
      const double value = rest.at[c] * panel.inverse_diagonal.at[c];
      rest.addScaled(-value, block(i, i).column[c]);
      x[i].at[c] = value;
    }
  }
  for (std::size_t i = size(); i-- > 0;) {
    const Panel& panel = panels_[i];
    Six& part = x[i];
    for (int c = panel.count; c-- > 0;) {
      double sum = part.at[c];
      for (int r = c + 1; r < panel.count; ++r) sum -= block(i, i).column[c].at[r] * part.at[r];
      part.at[c] = sum * panel.inverse_diagonal.at[c];
    }
    for (std::size_t j = panel.first; j < i; ++j)
      for (int c = 0; c < panels_[j].count; ++c) x[j].at[c] -= dot(block(i, j).column[c], part);
  }
}

}  // namespace tandem
