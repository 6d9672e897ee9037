#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "tandem/coordination/types.h"

namespace tandem::demos {

class SiteWorld;

/// Distances between the object copies of two sites.
struct PairCoherency {
  std::size_t one = 0, other = 0;  ///< sites from 0
  double mean = 0.0, max = 0.0;    ///< of several objects the largest distance [m]
};

/// Distances of object copies at equal time, tick by tick. For the thread that ticks the sites.
class Coherency {
 public:
  /// The worlds must outlive this.
  explicit Coherency(const std::vector<std::unique_ptr<SiteWorld>>& worlds);

  /// Adds the distances of now. Does nothing without objects.
  void add();
  /// Ends the means, over `ticks` ticks.
  void finish(double ticks);

  /// The largest distance of all pairs at each moment: its mean and its largest value [m].
  [[nodiscard]] double mean() const noexcept { return mean_; }
  [[nodiscard]] double max() const noexcept { return max_; }
  [[nodiscard]] const std::vector<PairCoherency>& pairs() const noexcept { return pairs_; }
  /// Mean distance of a site's first object to the others' as it received them [m].
  [[nodiscard]] double receivedMean(std::size_t site) const { return received_means_[site]; }

 private:
  void addReceived(std::size_t site);

  const std::vector<std::unique_ptr<SiteWorld>>& worlds_;
  std::vector<PairCoherency> pairs_;
  std::vector<double> received_means_;
  std::vector<std::vector<Vec3>> received_W_;  ///< first object of each remote, as last heard [m]
  double mean_ = 0.0, max_ = 0.0;
};

}  // namespace tandem::demos
