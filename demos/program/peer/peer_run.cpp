#include "peer/peer_run.h"

#include <cmath>
#include <stdexcept>

#include "peer/answer_check.h"
#include "scenario/site_checks.h"
#include "terminal/usage_error.h"
#include "world/received_object.h"

namespace tandem::demos {
namespace {

constexpr double kReportPeriod = 1.0;  // [s]
constexpr double kMostBehind = 0.1;    ///< a site later than this joins a running one [s]

}  // namespace

PeerRun::PeerRun(const Scenario& scenario, int site, const UdpMeshSettings& settings, UdpPeer peer,
                 HapticDevice* device, std::function<bool()> wants_grip, PeerPurpose purpose,
                 const BodyPlaces& places, std::optional<RelayAccess> relay)
    : scenario_(scenario),
      index_(site),
      device_(device),
      wants_grip_(std::move(wants_grip)),
      purpose_(purpose),
      places_(places),
      other_(peer.id),
      peers_(
          settings,
          [&] {
            std::vector<UdpPeer> peers;
            peers.push_back(std::move(peer));
            return peers;
          }(),
          std::move(relay)) {
  requireTwoSites(scenario, "tandem peer");
  if (scenario.site.contact_model != ContactModel::kIsland ||
      scenario.site.injection != Injection::kHandoff)
    throw UsageError(
        "tandem peer needs contact.model = island and bridge.injection = handoff; the others have "
        "no haptic rate of their own");
  makeWorld();
}

void PeerRun::makeWorld() {
  world_.reset();
  Link& link = peers_.link(other_);
  world_ = device_ ? std::make_unique<SiteWorld>(scenario_, index_, link, *device_, places_)
                   : std::make_unique<SiteWorld>(scenario_, index_, link, places_);
  Site& own = world_->site();
  if (scenario_.hasObject()) object_start_W_ = own.object(0).p_W;
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
  const auto own = static_cast<std::size_t>(index_);
  places.hands_W[1 - own] = computeStart(scenario_, makeSceneFrame(scenario_), 1 - index_);
  places.hands_W[own] = computeStart(scenario_, makeSceneFrame(scenario_), index_);
  site.betweenTicks([&] {
    if (site.tickCount() > 0) places.hands_W[own] = site.hip().p_W;
    if (site.counters().packets_taken > 0) places.hands_W[1 - own] = site.latest(0).user.p_W;
  });
  places.bodies = world_->places();
  return places;
}

PeerStatus PeerRun::peerStatus() const { return peers_.status(other_, readMonotonicClock()); }

bool PeerRun::waitForPeer(double patience, const std::function<bool()>& stop,
                          const std::function<void(const PeerReport&)>& report) {
  const PointState held{computeStart(scenario_, makeSceneFrame(scenario_), index_), Vec3::Zero()};
  peers_.agreeOnStart(held, scenario_.site.packet_rate, patience);
  AnswerCheck answers(peers_, other_, patience);
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
    try {
      if (start)
        answers.checkCountdown();
      else
        answers.check(now - began);
    } catch (const UsageError&) {
      peers_.sayFarewell(ByeReason::kConfigurationsDiffer);
      throw;
    } catch (const std::exception&) {
      peers_.sayFarewell(ByeReason::kProgramEnds);
      throw;
    }
    peers_.wait(1e-3);
  }
}

/// The other site has been running for a while: it and its copies fade in.
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
      next_report += kReportPeriod;
    }
    loop.stop();
    loop_ = loop.report();
  }
  peers_.sayFarewell(stop() ? ByeReason::kUserLeaves : ByeReason::kProgramEnds);
}

double PeerRun::computeCoherency() const noexcept {
  const Site& site = world_->site();
  if (!scenario_.hasObject()) return 0.0;
  const auto received = findObject(site.latest(0), 0);
  const Vec3& received_W = received ? received->p_W : object_start_W_;
  return (site.object(0).p_W - received_W).norm();
}

PeerReport PeerRun::makeReport(double time) {
  PeerReport report;
  report.time = time;
  report.has_start = peers_.start().has_value();
  report.peer = peerStatus();
  report.relay = peers_.relay(readMonotonicClock());
  world_->site().betweenTicks([&] {
    report.link = world_->site().linkState(0);
    report.force = world_->site().force().norm();
    report.coherency = computeCoherency();
  });
  return report;
}

}  // namespace tandem::demos
