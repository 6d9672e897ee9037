#include "peer/peer_run.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "usage_error.h"

namespace tandem::demos {
namespace {

constexpr double kReportPeriod = 1.0;  // [s]
constexpr double kMostBehind = 0.1;    ///< farther behind, a site gives up time [s]
constexpr double kFadeSlew = 2000.0;   ///< of the force at the end [N/s]
constexpr double kFarewell = 0.15;     ///< time to say it [s]
/// The start lies so far ahead that the other site hears of it in time: this, or round trips.
constexpr double kCountdown = 1.0;
constexpr double kCountdownTrips = 6.0;

const char* describe(RefuseCode code) {
  switch (code) {
    case RefuseCode::kVersion:
      return "it speaks another version; install the same release on both sides";
    case RefuseCode::kUnknownPeer:
      return "it does not expect this site; compare --site and --peer on both sides";
    case RefuseCode::kCookie:
      return "our datagrams reach it too late";
    case RefuseCode::kKey:
      return "it has another key; give both sides the same key file";
    case RefuseCode::kBusy:
      return "it is busy";
  }
  return "";
}

}  // namespace

PeerRun::PeerRun(const Scenario& scenario, int site, const UdpMeshSettings& settings, UdpPeer peer)
    : scenario_(scenario),
      index_(site),
      self_(settings.self),
      other_(peer.id),
      mesh_(settings,
            [&] {
              std::vector<UdpPeer> peers;
              peers.push_back(std::move(peer));
              return peers;
            }()),
      link_(mesh_.link(other_)) {
  makeWorld();
}

void PeerRun::makeWorld() {
  world_.reset();
  world_ = std::make_unique<SiteWorld>(scenario_, index_, link_);
  Site& own = world_->site();
  const auto ticks = static_cast<std::size_t>(std::llround(duration() * scenario_.haptic_rate));
  const auto arrivals = static_cast<std::size_t>(2.0 * duration() * scenario_.packet_rate) + 64;
  recording_ =
      std::make_unique<Recording>(ticks, arrivals, own.objectCount(), own.proxyBody(0) ? 1 : 0);
  own.record(recording_.get());
  if (scenario_.hasObject()) object_start_W_ = own.object(0).p_W;
}

double PeerRun::duration() const noexcept { return scenario_.duration; }

double PeerRun::receivedMean() const noexcept {
  return loop_.ticks > 0 ? coherency_sum_ / static_cast<double>(loop_.ticks) : 0.0;
}

void PeerRun::poll() noexcept {
  const double now = clock_.now();
  link_.setClock(now);
  mesh_.poll(now);
}

bool PeerRun::waitForPeer(double patience, const std::function<bool()>& stop,
                          const std::function<void(const PeerReport&)>& report) {
  const PointState held{computeStart(scenario_, makeSceneFrame(scenario_), index_), Vec3::Zero()};
  const double began = clock_.now();
  double next_send = began, next_report = began;
  std::optional<double> live_since;
  for (;;) {
    poll();
    const double now = clock_.now();
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
    if (link_.start() && now >= *link_.start() - 2e-3) {
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
  const PeerStatus status = mesh_.status(other_, clock_.now());
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
      status.refused ? fmt::format("it answers, but {}", describe(*status.refused))
                     : "is it running, is the address right, does a firewall let UDP pass?";
  throw Error(fmt::format("site {} at {} did not join within {} s: {}",
                          static_cast<std::uint32_t>(other_), where, patience, why));
}

void PeerRun::run(const std::function<bool()>& stop,
                  const std::function<void(const PeerReport&)>& report) {
  const double period = 1.0 / scenario_.haptic_rate;
  const auto count = static_cast<std::uint64_t>(std::llround(duration() * scenario_.haptic_rate));
  double next_report = 0.0;
  for (std::uint64_t tick = 0; tick < count && !stop(); ++tick) {
    const double time = static_cast<double>(tick) * period;
    clock_.sleepUntil(*link_.start() + time);
    const double lateness = clock_.now() - (*link_.start() + time);
    loop_.worst_lateness = std::max(loop_.worst_lateness, lateness);
    loop_.late += lateness > 0.5 * period;
    if (lateness > kMostBehind) {
      link_.setStart(*link_.start() + lateness);
      ++loop_.stalls;
    }
    poll();
    world_->site().tick(time);
    world_->stepHostUntil(time + period);
    ++loop_.ticks;
    coherency_sum_ += computeCoherency();
    if (time >= next_report) {
      report(makeReport(time));
      next_report += kReportPeriod;
    }
  }
  fadeForce();
  leave(stop() ? ByeReason::kUserLeaves : ByeReason::kProgramEnds);
}

/// Nothing is rendered any more, but a hand may still be there.
void PeerRun::fadeForce() noexcept {
  SimulatedDevice& device = world_->device();
  Vec3 force_W = world_->site().force();
  const double period = 1.0 / scenario_.haptic_rate;
  double time = static_cast<double>(loop_.ticks) * period;
  while (force_W.norm() > 0.0) {
    const double left = std::max(force_W.norm() - kFadeSlew * period, 0.0);
    force_W = left > 0.0 ? Vec3(force_W * (left / force_W.norm())) : Vec3::Zero();
    (void)device.read(time);
    device.write(force_W);
    clock_.sleepUntil(clock_.now() + period);
    time += period;
  }
}

void PeerRun::leave(ByeReason reason) noexcept {
  const double until = clock_.now() + kFarewell;
  mesh_.leave(clock_.now(), reason);
  while (clock_.now() < until) {
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

PeerReport PeerRun::makeReport(double time) const {
  PeerReport report;
  report.time = time;
  report.has_start = link_.start().has_value();
  report.peer = mesh_.status(other_, clock_.now());
  report.link = world_->site().linkState(0);
  report.force = world_->site().force().norm();
  report.coherency = computeCoherency();
  return report;
}

}  // namespace tandem::demos
