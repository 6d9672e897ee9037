#include "peer/answer_check.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "tandem/falcon/monotonic_clock.h"

#include "peer/changed_scenario.h"

namespace tandem::demos {
namespace {

constexpr double kFollowTime = 5.0;  // within which another site follows a change [s]

bool disagreesAboutChange(const PeerStatus& status) {
  return status.difference && status.difference->key == kChangeKey;
}

/// Explains a refusal in terms of the command line.
const char* explainRefusal(RefuseCode code) {
  if (code == RefuseCode::kUnknownPeer)
    return "it does not expect this site; compare --site and --peer on all sides";
  return explain(code);
}

}  // namespace

DisagreementError::DisagreementError(PeerId with, const std::string& what)
    : UsageError(fmt::format("site {} {}", static_cast<std::uint32_t>(with), what)), site(with) {}

std::optional<std::string> describeDifference(const PeerStatus& status) {
  if (status.difference && !disagreesAboutChange(status)) {
    const ConfigurationDifference& d = *status.difference;
    const auto show = [](const std::string& value) { return value.empty() ? "missing" : value; };
    return fmt::format(
        "has another scenario: {} is {} here and {} there; use the same file and --set on all "
        "sides",
        d.key, show(d.here), show(d.there));
  }
  if (status.left == ByeReason::kConfigurationsDiffer)
    return "says that it has another scenario; use the same file and --set on all sides";
  return std::nullopt;
}

PeerStatus AnswerCheck::readStatus() const { return peers_.status(other_, readMonotonicClock()); }

/// A site that leaves before the start will not be there at the start.
void AnswerCheck::checkCountdown() const {
  if (readStatus().phase != PeerPhase::kLeft) return;
  throw Error(fmt::format("site {} left before the start; start all again",
                          static_cast<std::uint32_t>(other_)));
}

void AnswerCheck::checkConfiguration(const PeerStatus& status, double waited) {
  const bool is_change = disagreesAboutChange(status);
  if (is_change && !disagrees_since_) disagrees_since_ = waited;
  if (is_change && waited - *disagrees_since_ < kFollowTime) return;
  if (is_change)
    throw DisagreementError(other_, "does not follow a change of scheme or gains; start all again");
  if (const auto difference = describeDifference(status))
    throw DisagreementError(other_, *difference);
}

void AnswerCheck::check(double waited) {
  const PeerStatus status = readStatus();
  checkConfiguration(status, waited);
  if (const auto refused = peers_.refusedCountdown())
    throw Error(
        fmt::format("site {} counts down {:.0f} s to the start, at most {:.0f} s are allowed; "
                    "raise --wait, and "
                    "if that does not help install the same release on all sides",
                    static_cast<std::uint32_t>(refused->peer), refused->length,
                    std::min(patience_, kLongestCountdown)));
  if (waited < patience_) return;
  const std::string where = status.address ? " at " + toString(*status.address) : "";
  std::string why = "is it running, does it know the way here, does a firewall let it pass?";
  if (status.address) why = "is it running, is the address right, does a firewall let UDP pass?";
  if (status.is_called_with_another_key)
    why = "it calls, but with another key; give all sites the same key file";
  if (const auto relay = peers_.relay(readMonotonicClock()); relay && !relay->is_in)
    why = relay->refused.empty() ? "the relay does not answer; is its address right?"
                                 : relay->refused;
  if (status.refused) why = fmt::format("it answers, but {}", explainRefusal(*status.refused));
  throw Error(fmt::format("site {}{} did not join within {} s: {}",
                          static_cast<std::uint32_t>(other_), where, patience_, why));
}

}  // namespace tandem::demos
