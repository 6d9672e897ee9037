#include "peer/peer_meeting.h"

#include <utility>

#include <fmt/format.h>

#include "tandem/falcon/monotonic_clock.h"

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr double kLookPeriod = 0.02;    // between two looks at the other sites [s]
constexpr double kFollowPeriod = 0.35;  // between two changes that are followed, at least [s]

}  // namespace

PeerMeeting::PeerMeeting(const Scenario& scenario, const PeerLine& line, PeerUser user)
    : line_(line),
      user_(std::move(user)),
      carrier_(makeCarrier(line, scenario.sites.size())),
      scenario_{scenario, 0} {
  makeRun(nullptr);
}

void PeerMeeting::makeRun(const ScenePlaces* places) {
  const ChangedScenario changed = scenario();
  Scenario from_here = changed.scenario;
  const bool goes_on = places && places->areNear();
  if (goes_on) startHandsAt(*places, from_here);
  UdpMeshSettings settings = makeMeshSettings(line_, changed);
  settings.carrier = carrier_.get();
  run_ = std::make_unique<PeerRun>(from_here, line_.site - 1, settings,
                                   makeOtherSites(line_, from_here.sites.size()), user_.device,
                                   user_.wants_grip, user_.purpose,
                                   goes_on ? places->bodies : BodyPlaces{}, makeRelayAccess(line_));
  line_.bind = toString(run_->peers().bound());
}

bool PeerMeeting::live(const PeerWatch& watch) {
  for (;;) {
    const bool has_met = meetOnce(watch);
    if (has_met) watch.after_run();
    if (!user_.may_follow && !refusal_.empty()) throw Error(refusal_);
    if (!next_) return has_met;
    goOn(watch);
  }
}

bool PeerMeeting::meetOnce(const PeerWatch& watch) {
  const auto stop = [&] { return watch.stop() || wantsNext(watch); };
  watch.has_world();
  try {
    if (!run_->waitForPeers(line_.patience, stop, watch.report)) return false;
  } catch (const DisagreementError& error) {
    if (!before_) throw;
    watch.note(fmt::format("site {} does not follow: scheme and gains are as before",
                           static_cast<std::uint32_t>(error.site)));
    next_ = std::exchange(before_, std::nullopt);
    return false;
  }
  before_.reset();
  watch.has_world();
  is_running_ = true;
  run_->run(stop, watch.report, watch.note, watch.after_step);
  is_running_ = false;
  return true;
}

bool PeerMeeting::wantsNext(const PeerWatch& watch) {
  if (next_ || takesProposal()) return true;
  const double now = readMonotonicClock();
  if (now < next_look_) return false;
  next_look_ = now + kLookPeriod;
  bool has_left = false;
  for (const PeerStatus& status : run_->statuses()) {
    if (takesFollowing(watch, status)) return true;
    has_left |= status.phase == PeerPhase::kLeft;
  }
  // A site that leaves between the agreement and the start has made a change, or comes again.
  has_left &= !is_running_ && run_->peers().start().has_value();
  if (has_left && (user_.purpose != PeerPurpose::kResults || scenario_.changes > 0))
    next_ = scenario_;
  return next_.has_value();
}

bool PeerMeeting::takesProposal() {
  const std::lock_guard lock(mutex_);
  if (!proposal_) return false;
  if (!before_) before_ = scenario_;
  next_ = std::exchange(proposal_, std::nullopt);
  next_->changes = scenario_.changes + 1;  // another's last one may have come meanwhile
  return true;
}

bool PeerMeeting::takesFollowing(const PeerWatch& watch, const PeerStatus& status) {
  if (!status.difference || readMonotonicClock() < followed_at_ + kFollowPeriod) return false;
  const auto number = static_cast<std::uint32_t>(status.peer);
  std::string refusal;
  try {
    auto followed = followChange(scenario_, *status.difference);
    if (!followed) return false;
    if (user_.may_follow) {
      next_ = std::move(followed);
      before_.reset();
      followed_at_ = readMonotonicClock();
      return true;
    }
    refusal = fmt::format(
        "site {} changes scheme or gains, and --out holds one scenario; start "
        "all again, or leave out --out",
        number);
  } catch (const UsageError& error) {
    refusal = fmt::format("site {} changes scheme or gains: {}", number, error.what());
  }
  if (refusal != refusal_) watch.note(refusal);
  refusal_ = refusal;
  return !user_.may_follow;
}

/// A scenario that no site can be made of leaves that of before.
void PeerMeeting::goOn(const PeerWatch& watch) {
  const ScenePlaces places = run_->places();
  run_.reset();  // its socket is free
  const auto change = [&](ChangedScenario to) {
    const std::lock_guard lock(mutex_);
    return std::exchange(scenario_, std::move(to));
  };
  const ChangedScenario last = change(*std::exchange(next_, std::nullopt));
  try {
    makeRun(&places);
  } catch (const std::exception& error) {
    watch.note(error.what());
    before_.reset();
    change(last);
    makeRun(&places);
  }
}

void PeerMeeting::propose(const Scenario& wanted) {
  const std::lock_guard lock(mutex_);
  proposal_ = proposeChange(scenario_, wanted);
}

ChangedScenario PeerMeeting::scenario() const {
  const std::lock_guard lock(mutex_);
  return scenario_;
}

}  // namespace tandem::demos
