#include "island/skyline_matrix.h"

#include <algorithm>
#include <cmath>

namespace tandem {
namespace {

double multiply(const double* a, const double* b, std::size_t count) noexcept {
  // Two sums: one would wait for itself.
  double even = 0.0, odd = 0.0;
  std::size_t i = 0;
  for (; i + 1 < count; i += 2) {
    even += a[i] * b[i];
    odd += a[i + 1] * b[i + 1];
  }
  return i < count ? even + odd + a[i] * b[i] : even + odd;
}

}  // namespace

SkylineMatrix::SkylineMatrix(std::size_t max_rows, std::size_t max_entries) {
  for (auto* places : {&firsts_, &starts_}) places->reserve(max_rows);
  inverse_diagonal_.reserve(max_rows);
  entries_.reserve(max_entries);
}

void SkylineMatrix::clear() noexcept {
  firsts_.clear();
  starts_.clear();
  entries_.clear();
}

double* SkylineMatrix::addRow(std::size_t first) noexcept {
  const std::size_t count = size() + 1 - first;
  firsts_.push_back(first);
  starts_.push_back(entries_.size());
  entries_.resize(entries_.size() + count);
  return &entries_[starts_.back()];
}

bool SkylineMatrix::factorise() noexcept {
  inverse_diagonal_.resize(size());
  for (std::size_t i = 0; i < size(); ++i) {
    double* const of_i = &entries_[starts_[i]];
    const std::size_t first_i = firsts_[i];
    for (std::size_t j = first_i; j < i; ++j) {
      const std::size_t first = std::max(first_i, firsts_[j]);
      of_i[j - first_i] -=
          multiply(of_i + (first - first_i), row(j) + (first - firsts_[j]), j - first);
      of_i[j - first_i] *= inverse_diagonal_[j];
    }
    double& diagonal = of_i[i - first_i];
    diagonal -= multiply(of_i, of_i, i - first_i);
    if (!(diagonal > 0.0) || !std::isfinite(diagonal)) return false;
    diagonal = std::sqrt(diagonal);
    inverse_diagonal_[i] = 1.0 / diagonal;
  }
  return true;
}

void SkylineMatrix::solve(std::vector<double>& x) const noexcept {
  for (std::size_t i = 0; i < size(); ++i)
    x[i] = (x[i] - multiply(row(i), &x[firsts_[i]], i - firsts_[i])) * inverse_diagonal_[i];
  for (std::size_t i = size(); i-- > 0;) {
    x[i] *= inverse_diagonal_[i];
    const double* const of_i = row(i);
    for (std::size_t j = firsts_[i]; j < i; ++j) x[j] -= of_i[j - firsts_[i]] * x[i];
  }
}

}  // namespace tandem
