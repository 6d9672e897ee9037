#include "tandem/plugin/haptic_loop.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "falcon/src/guard/realtime_rights.h"
#include "site/site_impl.h"

namespace tandem {
namespace {

/// A force that fades more slowly than this is taken away at once then [s].
constexpr double kLongestFade = 1.0;

/// For one writer.
void raise(std::atomic<double>& most, double value) noexcept {
  if (value > most.load(std::memory_order_relaxed)) most.store(value, std::memory_order_relaxed);
}

void add(std::atomic<std::uint64_t>& count, std::uint64_t more) noexcept {
  count.store(count.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
}

}  // namespace

struct HapticLoop::Impl {
  Impl(Site::Impl& own, const HapticLoopSettings& wanted) : site(own), settings(wanted) {}

  void run() noexcept;
  void waitForBegin() noexcept;
  std::uint64_t tickAt(std::uint64_t due) noexcept;

  Site::Impl& site;
  HapticLoopSettings settings;
  RealtimeRights rights;
  double begin = 0.0;
  std::atomic<bool> has_begun{false}, is_stopping{false}, has_ended{false};
  DurationHistogram lateness, tick_times;
  std::atomic<std::uint64_t> ticks{0}, skipped_ticks{0}, late_ticks{0};
  std::atomic<double> late_max{0.0}, tick_max{0.0}, longest_gap{0.0}, latest{0.0};
  bool was_late = false;  ///< ticks were skipped before the last one
  std::thread thread;
};

/// The island may be asked for meanwhile.
void HapticLoop::Impl::waitForBegin() noexcept {
  const double first = latest.load(std::memory_order_relaxed);
  while (!is_stopping.load(std::memory_order_acquire)) {
    const double next = readMonotonicClock() + site.timeline.period();
    if (next >= first) return;
    site.desk.serveUntil(next);
    site.desk.serve();
  }
}

/// Makes the tick whose moment it is: `due`, unless that has passed. Returns the next one.
std::uint64_t HapticLoop::Impl::tickAt(std::uint64_t due) noexcept {
  const double period = site.timeline.period();
  site.desk.serveUntil(begin + static_cast<double>(due) * period);
  const double start = readMonotonicClock();
  const double late = start - (begin + static_cast<double>(due) * period);
  const auto passed = static_cast<std::uint64_t>(std::max(late, 0.0) / period);
  due += passed;
  add(skipped_ticks, passed);
  add(late_ticks, late > 0.5 * period);
  lateness.add(std::max(late, 0.0));
  raise(late_max, late);
  if (ticks.load(std::memory_order_relaxed) > 0)
    raise(longest_gap, start - latest.load(std::memory_order_relaxed));
  latest.store(start, std::memory_order_relaxed);

  // One gap is made up for; who is late again and again has too much to do already.
  const double most_made_up = was_late ? 0.0 : kMostMadeUp;
  was_late = passed > 0;
  site.tick(static_cast<double>(due) * period, most_made_up);

  const double length = readMonotonicClock() - start;
  tick_times.add(length);
  raise(tick_max, length);
  add(ticks, 1);
  site.desk.serve();
  return due + 1;
}

void HapticLoop::Impl::run() noexcept {
  rights.take(settings.priority, settings.locks_memory);
  // A site that has ticked before goes on from there.
  auto due =
      static_cast<std::uint64_t>(std::llround(site.timeline.time() / site.timeline.period()));
  const double first = settings.begin.value_or(readMonotonicClock());
  begin = first - static_cast<double>(due) * site.timeline.period();
  latest.store(first, std::memory_order_relaxed);
  has_begun.store(true, std::memory_order_release);
  const double periods = std::min(settings.duration / site.timeline.period(), 1e18);
  const std::uint64_t end = due + static_cast<std::uint64_t>(std::llround(periods));
  waitForBegin();
  while (due < end && !is_stopping.load(std::memory_order_acquire)) due = tickAt(due);
  site.hand.setFading(true);
  const std::uint64_t last =
      due + static_cast<std::uint64_t>(kLongestFade / site.timeline.period());
  while (due < last && site.hand.force() != Vec3::Zero()) due = tickAt(due);
  site.hand.letGo();
  site.hand.setFading(false);
  // From here on those who ask take back their requests.
  site.desk.serve();
  site.desk.close();
  has_ended.store(true, std::memory_order_release);
}

HapticLoop::HapticLoop(Site& site, const HapticLoopSettings& settings)
    : impl_(std::make_unique<Impl>(*site.impl_, settings)) {
  Site::Impl& own = *site.impl_;
  if (own.ticksInHostStep())
    throw std::invalid_argument("a haptic loop needs a site with TickSource::kCaller");
  if (!own.handsOff())
    throw std::invalid_argument(
        "a haptic loop needs a site whose island hands off: ContactModel::kIsland and "
        "Injection::kHandoff");
  if (own.host_world.hasEnded())
    throw Error("the Bullet world of this site has been destroyed; make a new Site");
  if (own.desk.isOpen()) throw std::invalid_argument("the site has a haptic loop already");
  if (settings.priority < 0 || settings.priority > 99)
    throw std::invalid_argument("priority must be 0 to 99, 0 for none");
  if (settings.begin && !std::isfinite(*settings.begin))
    throw std::invalid_argument("begin must be a finite moment of the monotonic clock [s]");
  if (!(settings.duration >= 0.0))
    throw std::invalid_argument("duration must be a number of seconds, 0 or above");
  own.beginLive();
  own.desk.open();
  try {
    impl_->thread = std::thread([this] { impl_->run(); });
  } catch (const std::system_error& error) {
    own.desk.close();
    throw Error(std::string("no haptic thread: ") + error.what());
  }
  while (!impl_->has_begun.load(std::memory_order_acquire)) std::this_thread::yield();
}

HapticLoop::~HapticLoop() { stop(); }

void HapticLoop::stop() noexcept {
  if (!impl_->thread.joinable()) return;
  impl_->is_stopping.store(true, std::memory_order_release);
  impl_->thread.join();
}

bool HapticLoop::isRunning() const noexcept {
  return !impl_->has_ended.load(std::memory_order_acquire);
}

const std::vector<std::string>& HapticLoop::notes() const noexcept { return impl_->rights.notes(); }

LoopReport HapticLoop::report() const noexcept {
  const auto read = [](const auto& value) { return value.load(std::memory_order_relaxed); };
  LoopReport report;
  report.ticks = read(impl_->ticks);
  report.skipped = read(impl_->skipped_ticks);
  report.late = read(impl_->late_ticks);
  report.late_p50 = impl_->lateness.percentile(0.5);
  report.late_p99 = impl_->lateness.percentile(0.99);
  report.late_max = read(impl_->late_max);
  report.tick_p50 = impl_->tick_times.percentile(0.5);
  report.tick_p99 = impl_->tick_times.percentile(0.99);
  report.tick_max = read(impl_->tick_max);
  report.longest_gap = read(impl_->longest_gap);
  report.silence = std::max(0.0, readMonotonicClock() - read(impl_->latest));
  return report;
}

const DurationHistogram& HapticLoop::lateness() const noexcept { return impl_->lateness; }
const DurationHistogram& HapticLoop::tickTimes() const noexcept { return impl_->tick_times; }

}  // namespace tandem
