#pragma once

#include <vector>

#include "scenario/keys.h"

namespace tandem::demos {

/// Keys of each table [[site]], in the order of the document.
[[nodiscard]] const std::vector<KeyOf<SiteScenario>>& siteKeys();

/// Throws UsageError for a key of a site that the scenario does not have.
[[noreturn]] void refuseSite(const Place& place, const toml::node& node, std::size_t count);

/// The list `site`, and the same keys by the number of their site: `site1.hand` to
/// `site16.hand`. Two sites are shown as `site1` and `site2`, more as the list.
[[nodiscard]] std::vector<ScenarioKey> makeSiteKeys();

}  // namespace tandem::demos
