#pragma once

#include <cstdint>
#include <optional>

#include "tandem/coordination/configuration.h"

#include "scenario/scenario.h"

namespace tandem::demos {

/// Key of the item that tells a change. It sorts before all keys of scenarios, so that it is the
/// difference that peers find first.
inline constexpr const char* kChangeKey = "agreed.change";

/// A scenario whose scheme and gains the users of a session change while they meet. One user makes
/// a change, and the other sites follow (docs/network.md).
struct ChangedScenario {
  Scenario scenario;
  std::uint32_t changes = 0;  ///< so far; 0: it is as at the start
};

/// The next change by this site's user: scheme and gains of `wanted`. Throws UsageError if `wanted`
/// differs in something else that sites must share, or after 999,999,999 changes.
[[nodiscard]] ChangedScenario proposeChange(const ChangedScenario& own, const Scenario& wanted);

/// Hash of what sites tell their spectators of the scenario: all that sites must share but what may
/// change in a session, which is scheme, gains and users.
[[nodiscard]] std::uint32_t hashWatchedScenario(const Scenario& scenario);

/// The item by which a site tells the others its newest change; empty without one.
[[nodiscard]] std::optional<ConfigurationItem> describeChange(const ChangedScenario& own);

/// Chooses the scenario that a site goes on with, after another has told a difference: the newer
/// change wins, and of two with one number that whose text sorts first, at all sites alike. Empty
/// if the own one counts, or if sites differ in something else. The other's text is not trusted:
/// throws UsageError unless a scenario file could have all of its values.
[[nodiscard]] std::optional<ChangedScenario> followChange(
    const ChangedScenario& own, const ConfigurationDifference& difference);

}  // namespace tandem::demos
