#include "live_pair.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include <pthread.h>

#include "tandem/coordination/simulated_link.h"
#include "tandem/falcon/monotonic_clock.h"
#include "tandem/plugin/link_queue.h"

#include "crowd.h"
#include "demos/program/world/scene.h"
#include "falcon/src/guard/realtime_rights.h"

//   site 1                                                    site 2
//   host, with the crowd (this thread)                        host
//   haptic thread ── queue ──┐                     ┌── queue ── haptic thread
//                            └── wire: a simulated ┘
//                                network, a thread
namespace tandem::bench {
namespace {

/// Time for threads to start, from here to the first tick [s].
constexpr double kCountdown = 0.1;

/// The wire polls at this period, and looks this far ahead [s].
constexpr double kWirePeriod = 5e-4, kWireAhead = 2e-3;
/// The packet thread must not wait for the host threads, and no tick for it.
constexpr int kWireBelow = 10;
constexpr int kHurryBelow = 20;

/// Thread that takes the place of the sockets. Each site has its own clock, which began at
/// `begins`.
class Wire {
 public:
  Wire(const Impairments& network, LinkQueue& queue1, LinkQueue& queue2, const double begins[2],
       int priority)
      : ends_(makeSimulatedLinks(network)),
        queues_{&queue1, &queue2},
        begins_{begins[0], begins[1]},
        priority_(std::max(priority - kWireBelow, 0)),
        thread_([this] { run(); }) {}
  ~Wire() {
    is_stopping_.store(true, std::memory_order_relaxed);
    thread_.join();
  }
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;

 private:
  void run() {
    RealtimeRights rights;
    rights.take(priority_, false);
    double next = begins_[0];
    while (!is_stopping_.load(std::memory_order_relaxed)) {
      sleepUntil(next);
      const double now = readMonotonicClock();
      const double here = now - begins_[0], there = now - begins_[1];
      queues_[0]->exchange(*ends_.first, here, here + kWireAhead);
      queues_[1]->exchange(*ends_.second, there, there + kWireAhead);
      next = std::max(next + kWirePeriod, now);
    }
  }

  std::pair<std::unique_ptr<SimulatedLink>, std::unique_ptr<SimulatedLink>> ends_;
  LinkQueue* queues_[2];
  double begins_[2];
  int priority_;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

/// While it lives, the calling thread precedes the machine's other programs. All set-up is then
/// done when the first tick is due. Threads that start meanwhile keep this priority.
class Hurry {
 public:
  explicit Hurry(int priority) {
    sched_param wanted{};
    wanted.sched_priority = std::max(priority - kHurryBelow, 1);
    if (priority > 0) (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
  }
  ~Hurry() {
    const sched_param none{};
    (void)pthread_setschedparam(pthread_self(), SCHED_OTHER, &none);
  }
  Hurry(const Hurry&) = delete;
  Hurry& operator=(const Hurry&) = delete;
};

std::unique_ptr<Recording> makeRecording(const demos::Scenario& scenario, const Site& site) {
  // Room for the ticks in which the force fades.
  const double seconds = scenario.duration + 1.0;
  return std::make_unique<Recording>(
      static_cast<std::size_t>(std::llround(seconds * scenario.site.haptic_rate)),
      static_cast<std::size_t>(std::llround(2.0 * seconds * scenario.site.packet_rate)),
      site.objectCount(), site.proxyBody(0) ? 1 : 0);
}

}  // namespace

LivePairReport runLivePair(const demos::Scenario& scenario, const LivePairSettings& settings) {
  LinkQueue queues[2];
  demos::SiteWorld world1(scenario, 0, queues[0]), world2(scenario, 1, queues[1]);
  const Crowd crowd(world1.world(), settings.boxes);
  LivePairReport report;
  demos::SiteWorld* worlds[2] = {&world1, &world2};
  for (int s = 0; s < 2 && settings.records; ++s) {
    report.recordings[s] = makeRecording(scenario, worlds[s]->site());
    worlds[s]->site().record(report.recordings[s].get());
  }

  auto hurry = std::make_unique<Hurry>(settings.priority);
  // Two sites on two machines do not tick at the same moments. Half a period apart, neither waits
  // for the other here. By their own clocks both begin at 0.
  const double begin = readMonotonicClock() + kCountdown;
  const double begins[2] = {begin, begin + 0.5 / scenario.site.haptic_rate};
  {
    const Wire wire(scenario.network, queues[0], queues[1], begins, settings.priority);
    HapticLoop loop1(world1.site(), {settings.priority, true, begins[0]});
    HapticLoop loop2(world2.site(), {settings.priority, true, begins[1]});
    hurry.reset();
    const auto host = [&](int s) {
      std::uint64_t steps = 0;
      return runHost(begins[s], scenario.duration, scenario.host_rate, [&] {
        worlds[s]->stepHostUntil(static_cast<double>(++steps) / scenario.host_rate);
      });
    };
    std::thread other([&] { (void)host(1); });
    report.host = host(0);
    other.join();
    loop1.stop();
    loop2.stop();
    report.loop = loop1.report();
    report.notes = loop1.notes();
  }
  report.status = world1.site().status() | world2.site().status();
  report.packets_taken = world1.site().counters().packets_taken;
  report.lost = queues[0].lost() + queues[1].lost();
  return report;
}

}  // namespace tandem::bench
