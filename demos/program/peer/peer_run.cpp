#include "peer/peer_run.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "peer/mesh_thread.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr double kReportPeriod = 1.0;  // [s]
/// The threads are made so long before the start [s].
constexpr double kGetReady = 0.05;
constexpr double kMostBehind = 0.1;  ///< later than this, a site joins one that runs [s]
constexpr double kFarewell = 0.15;   ///< time to say it [s]
/// The start lies so far ahead that the other site hears of it in time: this, or round trips.
constexpr double kCountdown = 1.0;
constexpr double kCountdownTrips = 6.0;

/// In the words of the command line.
const char* explainRefusal(RefuseCode code) {
  if (code == RefuseCode::kUnknownPeer)
    return "it does not expect this site; compare --site and --peer on both sides";
  return explain(code);
}

}  // namespace

PeerRun::PeerRun(const Scenario& scenario, int site, const UdpMeshSettings& settings, UdpPeer peer,
                 HapticDevice* device)
    : scenario_(scenario),
      index_(site),
      device_(device),
      self_(settings.self),
      other_(peer.id),
      mesh_(settings,
            [&] {
              std::vector<UdpPeer> peers;
              peers.push_back(std::move(peer));
              return peers;
            }()),
      link_(mesh_.link(other_)) {
  if (scenario.contact_model != "island" || scenario.injection != "handoff")
    throw UsageError(
        "tandem peer needs contact.model = island and bridge.injection = handoff; the others have "
        "no haptic rate of their own");
  makeWorld();
}

void PeerRun::makeWorld() {
  world_.reset();
  world_ = device_ ? std::make_unique<SiteWorld>(scenario_, index_, queue_, *device_)
                   : std::make_unique<SiteWorld>(scenario_, index_, queue_);
  Site& own = world_->site();
  const auto ticks = static_cast<std::size_t>(std::llround(duration() * scenario_.haptic_rate));
  const auto arrivals = static_cast<std::size_t>(2.0 * duration() * scenario_.packet_rate) + 64;
  recording_ =
      std::make_unique<Recording>(ticks, arrivals, own.objectCount(), own.proxyBody(0) ? 1 : 0);
  own.record(recording_.get());
  if (scenario_.hasObject()) object_start_W_ = own.object(0).p_W;
}

double PeerRun::duration() const noexcept { return scenario_.duration; }

double PeerRun::receivedMean() const {
  if (!scenario_.hasObject() || recording_->ticks().empty()) return 0.0;
  auto next = recording_->arrivals().begin();
  const auto end = recording_->arrivals().end();
  std::uint64_t newest = 0;
  Vec3 received_W = object_start_W_;
  double sum = 0.0;
  for (std::size_t i = 0; i < recording_->ticks().size(); ++i) {
    for (; next != end && next->arrival.time <= recording_->ticks()[i].time; ++next) {
      const StatePacket& packet = next->arrival.packet;
      if (packet.sequence < newest || packet.object_count == 0) continue;
      newest = packet.sequence;
      received_W = packet.objects[0].state.p_W;
    }
    sum += (recording_->object(i, 0).island.p_W - received_W).norm();
  }
  return sum / static_cast<double>(recording_->ticks().size());
}

PeerStatus PeerRun::peerStatus() const { return mesh_.status(other_, readMonotonicClock()); }

void PeerRun::poll() noexcept {
  const double now = readMonotonicClock();
  link_.setClock(now);
  mesh_.poll(now);
}

bool PeerRun::waitForPeer(double patience, const std::function<bool()>& stop,
                          const std::function<void(const PeerReport&)>& report) {
  const PointState held{computeStart(scenario_, makeSceneFrame(scenario_), index_), Vec3::Zero()};
  const double began = readMonotonicClock();
  double next_send = began, next_report = began;
  std::optional<double> live_since;
  for (;;) {
    poll();
    const double now = readMonotonicClock();
    if (stop()) {
      leave(ByeReason::kUserLeaves);
      return false;
    }
    const PeerStatus status = mesh_.status(other_, now);
    const bool is_live = status.phase == PeerPhase::kLive && status.round_trip > 0.0;
    if (!is_live) live_since.reset();
    if (is_live && !live_since) live_since = now;
    link_.listenForStart(0.5 * status.round_trip + status.wait);
    const double lead = std::max(kCountdown, kCountdownTrips * status.round_trip);
    const bool may_choose = self_ < other_ && live_since && now - *live_since > 0.3;
    if (may_choose && !link_.start()) link_.setStart(now + lead);
    if (link_.start() && now >= *link_.start() - kGetReady) {
      if (now - *link_.start() > kMostBehind) joinLate(now);
      return true;
    }
    if (!link_.start()) {
      try {
        checkAnswer(now - began, patience);
      } catch (const UsageError&) {
        leave(ByeReason::kConfigurationsDiffer);
        throw;
      } catch (const std::exception&) {
        leave(ByeReason::kProgramEnds);
        throw;
      }
    }
    if (now >= next_send) {
      link_.sendHeld(held, self_);
      next_send = std::max(next_send + 1.0 / scenario_.packet_rate, now);
    }
    if (now >= next_report) {
      report(makeReport(link_.start() ? now - *link_.start() : 0.0));
      next_report += kReportPeriod;
    }
    mesh_.wait(1e-3);
  }
}

/// The other site has been running for a while: it and its copies fade in.
void PeerRun::joinLate(double now) {
  link_.setStart(now + kMostBehind);
  scenario_.starts_live = false;
  makeWorld();
}

void PeerRun::checkAnswer(double waited, double patience) const {
  const PeerStatus status = mesh_.status(other_, readMonotonicClock());
  if (status.difference) {
    const ConfigurationDifference& d = *status.difference;
    const auto show = [](const std::string& value) { return value.empty() ? "missing" : value; };
    throw UsageError(
        fmt::format("site {} has another scenario: {} is {} here and {} there; use "
                    "the same file and --set on both sides",
                    static_cast<std::uint32_t>(other_), d.key, show(d.here), show(d.there)));
  }
  if (status.left == ByeReason::kConfigurationsDiffer)
    throw UsageError(fmt::format(
        "site {} says that it has another scenario; use the same file and --set on both sides",
        static_cast<std::uint32_t>(other_)));
  if (waited < patience) return;
  const std::string where = status.address ? toString(*status.address) : "its address";
  const std::string why =
      status.refused ? fmt::format("it answers, but {}", explainRefusal(*status.refused))
                     : "is it running, is the address right, does a firewall let UDP pass?";
  throw Error(fmt::format("site {} at {} did not join within {} s: {}",
                          static_cast<std::uint32_t>(other_), where, patience, why));
}

void PeerRun::run(const std::function<bool()>& stop,
                  const std::function<void(const PeerReport&)>& report,
                  const std::function<void(const std::string&)>& note) {
  const double start = *link_.start();
  {
    const MeshThread network(mesh_, link_, queue_, mesh_mutex_);
    HapticLoopSettings settings;
    settings.begin = start;
    settings.duration = duration();
    HapticLoop loop(world_->site(), settings);
    for (const std::string& line : loop.notes()) note(line);
    double next_report = 0.0;
    for (std::uint64_t step = 1; loop.isRunning() && !stop(); ++step) {
      // A step comes when its time is over.
      const double time = static_cast<double>(step) / scenario_.host_rate;
      sleepUntil(start + time);
      world_->stepHostUntil(time);
      if (time < next_report) continue;
      report(makeReport(time));
      next_report += kReportPeriod;
    }
    loop.stop();
    loop_ = loop.report();
  }
  leave(stop() ? ByeReason::kUserLeaves : ByeReason::kProgramEnds);
}

void PeerRun::leave(ByeReason reason) noexcept {
  const double until = readMonotonicClock() + kFarewell;
  mesh_.leave(readMonotonicClock(), reason);
  while (readMonotonicClock() < until) {
    poll();
    mesh_.wait(5e-3);
  }
}

double PeerRun::computeCoherency() const noexcept {
  const Site& site = world_->site();
  if (!scenario_.hasObject()) return 0.0;
  const StatePacket& latest = site.latest(0);
  const Vec3& received_W = latest.object_count > 0 ? latest.objects[0].state.p_W : object_start_W_;
  return (site.object(0).p_W - received_W).norm();
}

PeerReport PeerRun::makeReport(double time) {
  PeerReport report;
  report.time = time;
  {
    const std::lock_guard lock(mesh_mutex_);
    report.has_start = link_.start().has_value();
    report.peer = peerStatus();
  }
  world_->site().betweenTicks([&] {
    report.link = world_->site().linkState(0);
    report.force = world_->site().force().norm();
    report.coherency = computeCoherency();
  });
  return report;
}

}  // namespace tandem::demos
