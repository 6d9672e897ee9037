#pragma once

#include <memory>
#include <vector>

#include "scenario/scenario.h"
#include "world/scene.h"

namespace tandem::demos {

/// The network of a run in virtual time: a link between each two sites, whose two ways may have
/// different delays. Each pair has a seed of its own, which the scenario's seed and the pair make;
/// sites 1 and 2 have the scenario's.
class SiteLinks {
 public:
  explicit SiteLinks(const Scenario& scenario);

  /// The links of a site, counted from 0, which live as long as this.
  [[nodiscard]] PeerLinks of(int site) const;

 private:
  void join(const Scenario& scenario, std::size_t one, std::size_t other);

  std::size_t count_;
  std::vector<std::unique_ptr<Link>> ends_;  ///< of a site to another, row by row; null: itself
};

}  // namespace tandem::demos
