#include "peer/watch_check.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "peer/changed_scenario.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

/// States that do not open, but none that does, for so long: the key is wrong [s].
constexpr double kForgedTime = 1.0;

std::string explainSilence(const RelayConnection& relay) {
  if (!relay.refused.empty()) return relay.refused;
  if (!relay.is_in) return "the relay does not answer; is its address right?";
  return "do the sites have --watch-key and this room?";
}

}  // namespace

RelayAccess makeWatchAccess(const PeerLine& line) {
  if (line.relay.empty() || line.relay_key.empty() || line.watch_key.empty())
    throw UsageError("--watch needs --relay, --relay-key and --watch-key");
  checkPatience(line);
  return *makeRelayAccess(line);
}

WatchCheck::WatchCheck(const Scenario* scenario, double patience, double now)
    : patience_(patience), begun_(now) {
  if (scenario) hash_ = hashWatchedScenario(*scenario);
}

bool WatchCheck::fits(const WatchedSite& site) const noexcept {
  return !hash_ || site.config_hash == *hash_;
}

void WatchCheck::check(const Watcher& watcher, double now) {
  const std::vector<PeerId> heard = watcher.heard();
  if (heard.empty()) return checkSilence(watcher, now);
  if (std::ranges::none_of(heard, [&](PeerId id) { return fits(*watcher.latest(id)); }))
    throw UsageError(
        fmt::format("site {} has another scenario; use the file and --set that the sites have",
                    static_cast<std::uint32_t>(heard.front())));
}

void WatchCheck::checkSilence(const Watcher& watcher, double now) {
  const std::vector<RefusedDatagrams> refused = watcher.refused();
  const bool is_forged = std::ranges::any_of(
      refused, [](const RefusedDatagrams& some) { return some.reason == "forged"; });
  if (is_forged && !first_forged_) first_forged_ = now;
  if (first_forged_ && now - *first_forged_ >= kForgedTime)
    throw Error("--watch-key opens no state of this room; take the file that the sites have");
  if (now - begun_ >= patience_)
    throw Error(fmt::format("no site was heard for {} s: {}", patience_,
                            explainSilence(watcher.relay(now))));
}

}  // namespace tandem::demos
