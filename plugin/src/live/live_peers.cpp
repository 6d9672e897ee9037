#include "tandem/plugin/live_peers.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include "tandem/falcon/monotonic_clock.h"

#include "coordination/src/tandem_assert.h"
#include "falcon/src/guard/realtime_rights.h"
#include "live/peer_link.h"
#include "live/start_exchange.h"

namespace tandem {
namespace {

constexpr double kPause = 0.25e-3;       ///< of the thread between two polls [s]
constexpr double kFarewell = 0.15;       ///< time to say it [s]
constexpr double kFarewellPause = 5e-3;  // [s]

/// States go to the haptic thread so long before they are due: two ticks at 1 kHz, or a poll of
/// a caller that polls at 50 Hz [s].
constexpr double kThreadAhead = 2e-3, kCallerAhead = 0.02;

struct PeerEnd {
  PeerEnd(PeerId peer, Link& way) : id(peer), link(way) {}

  PeerId id;
  PeerLink link;
};

[[nodiscard]] std::vector<PeerId> listIds(const std::vector<UdpPeer>& peers) {
  std::vector<PeerId> ids;
  for (const UdpPeer& peer : peers) ids.push_back(peer.id);
  return ids;
}

}  // namespace

struct LivePeers::Impl {
  Impl(const UdpMeshSettings& settings, std::vector<UdpPeer> peers, const std::vector<PeerId>& ids,
       std::optional<RelayAccess> relay)
      : self(settings.self), mesh(settings, std::move(peers), std::move(relay)) {
    for (const PeerId id : ids) ends.push_back(std::make_unique<PeerEnd>(id, mesh.link(id)));
  }

  [[nodiscard]] PeerEnd& find(PeerId peer);
  void advance(double now, std::optional<double> site_time, double ahead) noexcept;
  void lookForStart(double now) noexcept;
  void run(int priority) noexcept;
  void setHapticThreads(bool have_one) noexcept;

  PeerId self;
  mutable std::mutex mutex;  ///< held for each poll of the thread
  UdpMesh mesh;
  std::vector<std::unique_ptr<PeerEnd>> ends;
  std::optional<StartExchange> exchange;
  std::vector<StartExchange::Peer> seen;  ///< by the exchange; has room for all
  std::optional<double> start;
  std::atomic<bool> is_stopping{false};
  std::thread thread;
};

PeerEnd& LivePeers::Impl::find(PeerId peer) {
  (void)mesh.link(peer);  // throws for an id that is no peer
  return **std::find_if(ends.begin(), ends.end(), [&](const auto& end) { return end->id == peer; });
}

void LivePeers::Impl::advance(double now, std::optional<double> site_time, double ahead) noexcept {
  mesh.poll(now);
  for (const auto& end : ends) end->link.bridge().setClock(now);
  if (exchange) lookForStart(now);
  for (const auto& end : ends) {
    if (site_time) end->link.bridge().setSiteTime(*site_time);
    end->link.exchange(ahead);
  }
}

void LivePeers::Impl::lookForStart(double now) noexcept {
  seen.clear();
  for (const auto& end : ends) {
    const PeerStatus status = mesh.status(end->id, now);
    seen.push_back({end->id, end->link.bridge(), status.phase == PeerPhase::kLive,
                    status.round_trip, status.wait});
  }
  exchange->advance(now, seen);
  start = exchange->start();
  if (start && now >= *start - kGetReady) exchange.reset();
}

void LivePeers::Impl::run(int priority) noexcept {
  RealtimeRights rights;
  if (priority > 0) rights.take(priority, false);
  while (!is_stopping.load(std::memory_order_relaxed)) {
    {
      const std::lock_guard lock(mutex);
      advance(readMonotonicClock(), std::nullopt, kThreadAhead);
    }
    mesh.wait(kPause);
  }
}

void LivePeers::Impl::setHapticThreads(bool have_one) noexcept {
  for (const auto& end : ends) end->link.setHapticThread(have_one);
}

LivePeers::LivePeers(const UdpMeshSettings& settings, std::vector<UdpPeer> peers,
                     std::optional<RelayAccess> relay) {
  const std::vector<PeerId> ids = listIds(peers);
  impl_ = std::make_unique<Impl>(settings, std::move(peers), ids, std::move(relay));
}

LivePeers::~LivePeers() { stopThread(); }

Link& LivePeers::link(PeerId peer) { return impl_->find(peer).link; }

void LivePeers::startThread(int priority) {
  if (priority < 0 || priority > 99)
    throw std::invalid_argument("priority = " + std::to_string(priority) +
                                ": must be 0 to 99, 0 for none");
  if (impl_->thread.joinable())
    throw std::invalid_argument("the thread of these peers runs already; stop it first");
  impl_->is_stopping.store(false, std::memory_order_relaxed);
  impl_->setHapticThreads(true);
  try {
    impl_->thread = std::thread([this, priority] { impl_->run(priority); });
  } catch (const std::system_error& error) {
    impl_->setHapticThreads(false);
    throw Error(std::string("no thread for the socket: ") + error.what() +
                "; end other threads, or poll yourself");
  }
}

void LivePeers::stopThread() noexcept {
  if (!impl_->thread.joinable()) return;
  impl_->is_stopping.store(true, std::memory_order_relaxed);
  impl_->thread.join();
  impl_->setHapticThreads(false);
}

void LivePeers::poll(double now) noexcept {
  TANDEM_ASSERT(!impl_->thread.joinable());
  impl_->advance(now, std::nullopt, kCallerAhead);
}

void LivePeers::poll(double now, double site_time) noexcept {
  TANDEM_ASSERT(!impl_->thread.joinable());
  impl_->advance(now, site_time, kCallerAhead);
}

void LivePeers::wait(double seconds) const noexcept { impl_->mesh.wait(seconds); }

void LivePeers::setHapticThread(PeerId peer, bool has_one) {
  impl_->find(peer).link.setHapticThread(has_one);
}

void LivePeers::agreeOnStart(const PointState& held, double rate, double longest) {
  if (!(rate > 0.0 && std::isfinite(rate)))
    throw std::invalid_argument("rate = " + std::to_string(rate) +
                                ": must be above 0 and finite [1/s]");
  if (!(longest > 0.0))
    throw std::invalid_argument("longest = " + std::to_string(longest) + ": must be above 0 [s]");
  const std::lock_guard lock(impl_->mutex);
  impl_->start.reset();
  for (const auto& end : impl_->ends) end->link.bridge().awaitStart();
  impl_->seen.reserve(impl_->ends.size());
  impl_->exchange.emplace(impl_->self, held, rate, std::min(longest, kLongestCountdown));
}

std::optional<RefusedCountdown> LivePeers::refusedCountdown() const noexcept {
  const std::lock_guard lock(impl_->mutex);
  return impl_->exchange ? impl_->exchange->refused() : std::nullopt;
}

std::optional<double> LivePeers::start() const noexcept {
  const std::lock_guard lock(impl_->mutex);
  return impl_->start;
}

void LivePeers::setStart(double start) {
  if (!std::isfinite(start))
    throw std::invalid_argument("start = " + std::to_string(start) + ": must be finite [s]");
  const std::lock_guard lock(impl_->mutex);
  impl_->exchange.reset();
  impl_->start = start;
  for (const auto& end : impl_->ends) end->link.bridge().setStart(start);
}

void LivePeers::sayFarewell(ByeReason reason) noexcept {
  stopThread();
  leave(readMonotonicClock(), reason);
  for (const double until = readMonotonicClock() + kFarewell; readMonotonicClock() < until;) {
    impl_->mesh.poll(readMonotonicClock());
    impl_->mesh.wait(kFarewellPause);
  }
}

void LivePeers::leave(double now, ByeReason reason) noexcept {
  const std::lock_guard lock(impl_->mutex);
  impl_->mesh.leave(now, reason);
}

std::optional<RelayConnection> LivePeers::relay(double now) const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->mesh.relay(now);
}

PeerStatus LivePeers::status(PeerId peer, double now) const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->mesh.status(peer, now);
}

std::uint64_t LivePeers::lost() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& end : impl_->ends) sum += end->link.lost();
  return sum;
}

std::uint64_t LivePeers::received() const noexcept {
  const std::lock_guard lock(impl_->mutex);
  return impl_->mesh.received();
}

std::vector<RefusedDatagrams> LivePeers::refused() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->mesh.refused();
}

Address LivePeers::bound() const noexcept { return impl_->mesh.bound(); }

}  // namespace tandem
