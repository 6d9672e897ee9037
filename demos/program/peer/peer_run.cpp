#include "peer/peer_run.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "terminal/usage_error.h"
#include "world/received_object.h"

namespace tandem::demos {
namespace {

constexpr double kReportPeriod = 1.0;  // [s]
constexpr double kMostBehind = 0.1;    ///< a site later than this joins running ones [s]
constexpr double kFirstLook = 2.0;     ///< by then the round trip is known [s]

std::vector<PeerId> listIds(const std::vector<UdpPeer>& peers) {
  std::vector<PeerId> ids;
  for (const UdpPeer& peer : peers) ids.push_back(peer.id);
  return ids;
}

/// The place of a site in a scenario.
std::size_t placeOf(PeerId id) { return static_cast<std::size_t>(id) - 1; }

}  // namespace

PeerRun::PeerRun(const Scenario& scenario, int site, const UdpMeshSettings& settings,
                 std::vector<UdpPeer> peers, HapticDevice* device, std::function<bool()> wants_grip,
                 PeerPurpose purpose, const BodyPlaces& places, std::optional<RelayAccess> relay)
    : scenario_(scenario),
      index_(site),
      device_(device),
      wants_grip_(std::move(wants_grip)),
      purpose_(purpose),
      places_(places),
      others_(listIds(peers)),
      peers_(settings, std::move(peers), std::move(relay)),
      growth_(scenario) {
  if (scenario.site.contact_model != ContactModel::kIsland ||
      scenario.site.injection != Injection::kHandoff)
    throw UsageError(
        "tandem peer needs contact.model = island and bridge.injection = handoff; the others have "
        "no haptic rate of their own");
  makeWorld();
}

void PeerRun::makeWorld() {
  world_.reset();
  std::vector<Link*> all;
  for (const PeerId other : others_) all.push_back(&peers_.link(other));
  const PeerLinks links(std::move(all));
  world_ = device_ ? std::make_unique<SiteWorld>(scenario_, index_, links, *device_, places_)
                   : std::make_unique<SiteWorld>(scenario_, index_, links, places_);
  if (purpose_ == PeerPurpose::kSession) return;
  record_ = std::make_unique<SiteRecord>(
      scenario_, index_, *world_, purpose_ == PeerPurpose::kResults ? duration() : kLongestRecord);
}

double PeerRun::duration() const noexcept {
  return purpose_ == PeerPurpose::kResults ? scenario_.duration : HUGE_VAL;
}

ScenePlaces PeerRun::places() {
  ScenePlaces places;
  Site& site = world_->site();
  const SceneFrame frame = makeSceneFrame(scenario_);
  for (std::size_t user = 0; user < scenario_.sites.size(); ++user)
    places.hands_W.push_back(computeStart(scenario_, frame, static_cast<int>(user)));
  site.betweenTicks([&] {
    if (site.tickCount() > 0) places.hands_W[static_cast<std::size_t>(index_)] = site.hip().p_W;
    for (std::size_t i = 0; i < others_.size(); ++i) {
      const StatePacket& latest = site.latest(static_cast<int>(i));
      if (latest.sequence > 0) places.hands_W[placeOf(others_[i])] = latest.user.p_W;
    }
  });
  places.bodies = world_->places();
  return places;
}

std::vector<PeerStatus> PeerRun::statuses() const {
  const double now = readMonotonicClock();
  std::vector<PeerStatus> all;
  for (const PeerId other : others_) all.push_back(peers_.status(other, now));
  return all;
}

bool PeerRun::waitForPeers(double patience, const std::function<bool()>& stop,
                           const std::function<void(const PeerReport&)>& report) {
  const PointState held{computeStart(scenario_, makeSceneFrame(scenario_), index_), Vec3::Zero()};
  peers_.agreeOnStart(held, scenario_.site.packet_rate, patience);
  if (scenario_.site.membership.follows) {
    joinLate(readMonotonicClock());
    return true;
  }
  std::vector<AnswerCheck> answers;
  for (const PeerId other : others_) answers.emplace_back(peers_, other, patience);
  const double began = readMonotonicClock();
  double next_report = began;
  for (;;) {
    const double now = readMonotonicClock();
    peers_.poll(now);
    if (stop()) {
      peers_.sayFarewell(ByeReason::kUserLeaves);
      return false;
    }
    const std::optional<double> start = peers_.start();
    if (start && now >= *start - LivePeers::kGetReady) {
      if (now - *start > kMostBehind) joinLate(now);
      return true;
    }
    if (now >= next_report) {
      report(makeReport(start ? now - *start : 0.0));
      next_report += kReportPeriod;
    }
    checkAnswers(answers, now - began);
    peers_.wait(1e-3);
  }
}

/// Says farewell before it throws.
void PeerRun::checkAnswers(std::vector<AnswerCheck>& answers, double waited) {
  try {
    for (AnswerCheck& answer : answers) {
      if (peers_.start())
        answer.checkCountdown();
      else
        answer.check(waited);
    }
  } catch (const UsageError&) {
    peers_.sayFarewell(ByeReason::kConfigurationsDiffer);
    throw;
  } catch (const std::exception&) {
    peers_.sayFarewell(ByeReason::kProgramEnds);
    throw;
  }
}

/// Other sites have been running for a while, or come later: they and their copies fade in.
void PeerRun::joinLate(double now) {
  peers_.setStart(now + kMostBehind);
  scenario_.site.link_loss.start_live = false;
  makeWorld();
}

void PeerRun::run(const std::function<bool()>& stop,
                  const std::function<void(const PeerReport&)>& report,
                  const std::function<void(const std::string&)>& note,
                  const std::function<void(double, const HapticLoop&)>& after_step) {
  const double start = *peers_.start();
  peers_.startThread();
  {
    HapticLoopSettings settings;
    settings.begin = start;
    settings.duration = duration();
    HapticLoop loop(world_->site(), settings);
    for (const std::string& line : loop.notes()) note(line);
    double next_report = 0.0;
    for (std::uint64_t step = 1; loop.isRunning() && !stop(); ++step) {
      // A host step runs when its time is over.
      const double time = static_cast<double>(step) / scenario_.host_rate;
      sleepUntil(start + time);
      world_->stepHostUntil(time);
      if (record_) record_->noteStep(time);
      if (wants_grip_) world_->hold(wants_grip_());
      if (after_step) after_step(time, loop);
      if (time < next_report) continue;
      report(makeReport(time));
      noteDifferences(note);
      noteGrowth(time, note);
      next_report += kReportPeriod;
    }
    loop.stop();
    loop_ = loop.report();
  }
  peers_.sayFarewell(stop() ? ByeReason::kUserLeaves : ByeReason::kProgramEnds);
}

/// A site that comes while this one runs takes no part if it has another scenario.
void PeerRun::noteDifferences(const std::function<void(const std::string&)>& note) {
  for (const PeerStatus& status : statuses()) {
    const auto difference = describeDifference(status);
    if (!difference || std::ranges::find(noted_, status.peer) != noted_.end()) continue;
    noted_.push_back(status.peer);
    note(fmt::format("site {} {}", static_cast<std::uint32_t>(status.peer), *difference));
  }
}

/// Tells when the gains do not fit the delay to the farthest peer.
void PeerRun::noteGrowth(double time, const std::function<void(const std::string&)>& note) {
  if (time < kFirstLook) return;
  double longest = -1.0;
  for (const PeerStatus& status : statuses())
    if (status.phase == PeerPhase::kLive)
      longest = std::max(longest, 0.5 * status.round_trip + status.wait);
  if (const auto line = growth_.look(longest)) note(*line);
}

double PeerRun::computeCoherency() const noexcept {
  const Site& site = world_->site();
  if (!scenario_.hasObject()) return 0.0;
  const auto farthest = findFarthestCopy(site);
  return farthest ? (site.object(0).p_W - farthest->p_W).norm() : 0.0;
}

PeerReport PeerRun::makeReport(double time) {
  PeerReport report;
  report.time = time;
  report.has_start = peers_.start().has_value();
  for (PeerStatus& status : statuses()) report.others.push_back({std::move(status)});
  report.relay = peers_.relay(readMonotonicClock());
  world_->site().betweenTicks([&] {
    for (std::size_t i = 0; i < report.others.size(); ++i)
      report.others[i].link = world_->site().linkState(static_cast<int>(i));
    report.force = world_->site().force().norm();
    if (scenario_.site.membership.follows) report.members = world_->site().memberCount();
    report.coherency = computeCoherency();
  });
  return report;
}

}  // namespace tandem::demos
