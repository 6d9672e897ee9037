#include "watch/watch_session.h"

#include "tandem/falcon/monotonic_clock.h"

namespace tandem::view {
namespace {

constexpr double kLookPeriod = 0.005;  // at the socket [s]

}  // namespace

WatchSession::WatchSession(const demos::Scenario& scenario, const demos::PeerLine& line)
    : begun_(readMonotonicClock()),
      check_(&scenario, line.patience, begun_),
      watcher_(demos::makeWatchAccess(line),
               line.bind.empty() ? Address{} : resolveAddress(line.bind)),
      room_(scenario) {
  lookAtRoom(begun_);
  thread_ = std::jthread([this](const std::stop_token& stop) { live(stop); });
}

WatchSession::~WatchSession() = default;

void WatchSession::live(const std::stop_token& stop) {
  liveToTheEnd([&] {
    while (!stop.stop_requested()) {
      const double now = readMonotonicClock();
      watcher_.poll(now);
      check_.check(watcher_, now);
      takeStates();
      if (isLookDue(now)) lookAtRoom(now);
      watcher_.wait(kLookPeriod);
    }
  });
}

void WatchSession::takeStates() {
  for (const PeerId id : watcher_.heard()) {
    const WatchedSite& site = *watcher_.latest(id);
    room_.take(static_cast<int>(id) - 1, site, check_.fits(site));
  }
}

void WatchSession::lookAtRoom(double now) {
  const int wanted = wanted_;
  const auto look = std::make_shared<SessionLook>(
      room_.look(now, wanted == kNobody ? std::nullopt : std::optional(wanted), details()));
  look->time = now - begun_;
  publish(look);
  const RelayConnection relay = watcher_.relay(now);
  tell(relay.refused.empty() ? std::vector<std::string>{}
                             : std::vector<std::string>{"relay: " + relay.refused});
}

}  // namespace tandem::view
