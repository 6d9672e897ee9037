#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "support/random.h"

namespace tandem::test {

/// A condition: one level of each factor.
using Levels = std::vector<int>;

/// Two levels that are meaningless together.
struct ExcludedPair {
  std::size_t factor = 0;
  int level = 0;
  std::size_t other_factor = 0;
  int other_level = 0;
};

/// Rows such that any two levels of different factors occur together in one row, except for
/// excluded pairs. Each row holds one level per factor. Greedy: draws some rows, fills each level
/// by level with the level that covers most, and takes the best. Once all pairs are covered,
/// further rows cover as many triples as they can.
class CoveringArray {
 public:
  /// `excluded` must leave a level of every factor for any choice of the others.
  CoveringArray(std::vector<int> level_counts, std::vector<ExcludedPair> excluded)
      : counts_(std::move(level_counts)), excluded_(std::move(excluded)) {
    for (const int count : counts_) {
      first_.push_back(total_);
      total_ += static_cast<std::size_t>(count);
    }
    pairs_.resize(total_ * total_);
    triples_.resize(total_ * total_ * total_);
    findOpenPairs();
  }

  /// Makes at least `count` rows, and as many as all pairs take.
  [[nodiscard]] std::vector<Levels> makeRows(std::size_t count) {
    std::vector<Levels> rows;
    while (rows.size() < count || !open_pairs_.empty()) {
      Levels best;
      int most = -1;
      for (int i = 0; i < kCandidates; ++i) {
        const Levels row = drawRow();
        const int gain = countNew(row);
        if (gain > most) most = gain, best = row;
      }
      cover(best);
      rows.push_back(best);
      if (open_pairs_.empty() && pair_rows_ == 0) pair_rows_ = rows.size();
    }
    return rows;
  }

  /// Number of rows after which all pairs are covered.
  [[nodiscard]] std::size_t pairRows() const { return pair_rows_; }

  [[nodiscard]] bool isExcluded(std::size_t f, int level, std::size_t g, int other) const {
    return std::any_of(excluded_.begin(), excluded_.end(), [&](const ExcludedPair& pair) {
      return (pair.factor == f && pair.level == level && pair.other_factor == g &&
              pair.other_level == other) ||
             (pair.factor == g && pair.level == other && pair.other_factor == f &&
              pair.other_level == level);
    });
  }

 private:
  static constexpr int kCandidates = 40;
  static constexpr int kUnset = -1;

  struct Pair {
    std::size_t f = 0, g = 0;
    int level = 0, other = 0;
  };

  [[nodiscard]] std::size_t id(std::size_t factor, int level) const {
    return first_[factor] + static_cast<std::size_t>(level);
  }
  [[nodiscard]] std::size_t pairId(std::size_t a, std::size_t b) const {
    return std::min(a, b) * total_ + std::max(a, b);
  }
  [[nodiscard]] std::size_t tripleId(std::size_t a, std::size_t b, std::size_t c) const {
    const std::size_t low = std::min({a, b, c}), high = std::max({a, b, c});
    return (low * total_ + (a + b + c - low - high)) * total_ + high;
  }

  void findOpenPairs() {
    open_pairs_.clear();
    for (std::size_t f = 0; f < counts_.size(); ++f)
      for (std::size_t g = f + 1; g < counts_.size(); ++g)
        for (int level = 0; level < counts_[f]; ++level)
          for (int other = 0; other < counts_[g]; ++other)
            if (!pairs_[pairId(id(f, level), id(g, other))] && !isExcluded(f, level, g, other))
              open_pairs_.push_back({f, g, level, other});
  }

  [[nodiscard]] bool isAllowed(const Levels& row, std::size_t factor, int level) const {
    for (std::size_t g = 0; g < row.size(); ++g)
      if (row[g] != kUnset && isExcluded(factor, level, g, row[g])) return false;
    return true;
  }

  [[nodiscard]] Levels drawRow() {
    Levels row(counts_.size(), kUnset);
    if (!open_pairs_.empty()) {
      const Pair& start = open_pairs_[static_cast<std::size_t>(
          random_.below(static_cast<int>(open_pairs_.size())))];
      row[start.f] = start.level;
      row[start.g] = start.other;
    }
    std::vector<std::size_t> order(counts_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[static_cast<std::size_t>(random_.below(static_cast<int>(i)))]);
    for (const std::size_t factor : order)
      if (row[factor] == kUnset) row[factor] = chooseLevel(row, factor);
    return row;
  }

  /// The level that covers most together with those already set; draws among equals.
  [[nodiscard]] int chooseLevel(const Levels& row, std::size_t factor) {
    int best = 0, most = -1;
    const int turn = random_.below(counts_[factor]);
    for (int i = 0; i < counts_[factor]; ++i) {
      const int level = (i + turn) % counts_[factor];
      if (!isAllowed(row, factor, level)) continue;
      const int gain = countNew(row, factor, level);
      if (gain > most) most = gain, best = level;
    }
    return best;
  }

  /// Open pairs of this level with those already set, or triples once no pair is open.
  [[nodiscard]] int countNew(const Levels& row, std::size_t factor, int level) const {
    int gain = 0;
    const std::size_t own = id(factor, level);
    for (std::size_t g = 0; g < row.size(); ++g) {
      if (g == factor || row[g] == kUnset) continue;
      const std::size_t other = id(g, row[g]);
      if (!open_pairs_.empty()) {
        gain += pairs_[pairId(own, other)] ? 0 : 1;
        continue;
      }
      for (std::size_t h = g + 1; h < row.size(); ++h)
        if (h != factor && row[h] != kUnset && !triples_[tripleId(own, other, id(h, row[h]))])
          ++gain;
    }
    return gain;
  }
  [[nodiscard]] int countNew(const Levels& row) const {
    int gain = 0;
    for (std::size_t f = 0; f < row.size(); ++f) gain += countNew(row, f, row[f]);
    return gain;
  }

  void cover(const Levels& row) {
    for (std::size_t f = 0; f < row.size(); ++f)
      for (std::size_t g = f + 1; g < row.size(); ++g) {
        pairs_[pairId(id(f, row[f]), id(g, row[g]))] = true;
        for (std::size_t h = g + 1; h < row.size(); ++h)
          triples_[tripleId(id(f, row[f]), id(g, row[g]), id(h, row[h]))] = true;
      }
    findOpenPairs();
  }

  std::vector<int> counts_;
  std::vector<ExcludedPair> excluded_;
  std::vector<std::size_t> first_;  ///< index of a factor's first level among all levels
  std::size_t total_ = 0;
  std::vector<bool> pairs_, triples_;
  std::vector<Pair> open_pairs_;
  std::size_t pair_rows_ = 0;
  Random random_{20090203};
};

}  // namespace tandem::test
