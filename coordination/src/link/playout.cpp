#include "link/playout.h"

#include <algorithm>
#include <cmath>

#include "bad_value.h"

namespace tandem {
namespace {

bool isWithin(double value, double low, double high) noexcept {
  return value >= low && value <= high;
}

}  // namespace

void checkPlayoutSettings(const PlayoutSettings& s) {
  if (!isWithin(s.most, 0.0, 1.0)) throwBadValue("playout most", s.most, "0 to 1 s");
  if (!isWithin(s.quantile, 0.5, 1.0)) throwBadValue("playout quantile", s.quantile, "0.5 to 1");
  if (!isWithin(s.slew, 1e-4, 1.0)) throwBadValue("playout slew", s.slew, "0.0001 to 1");
  if (!isWithin(s.max_late, 0.01, 60.0))
    throwBadValue("playout max_late", s.max_late, "0.01 to 60 s");
  if (s.room < 2 || s.room > 4096)
    throwBadValue("playout room", static_cast<double>(s.room), "2 to 4096");
}

Playout::Playout(const PlayoutSettings& settings) : settings_(settings) {
  checkPlayoutSettings(settings);
  waiting_.reserve(settings.room);
}

Playout::Verdict Playout::push(const StatePacket& packet, double sent, double now) noexcept {
  const double transit = now - sent;  // includes the offset of the clocks
  if (transit - fastest_.value() > settings_.max_late && !isNewRoute(transit, now)) {
    ++counts_.too_late;
    return Verdict::kTooLate;
  }
  noteInTime();
  if (transit >= fast_ - std::max(settings_.most, kJump)) fastest_.add(transit, now);
  const double lateness = transit - fastest_.value();
  learn(transit, lateness, now);
  if (isStale(packet)) {
    ++counts_.stale;
    return Verdict::kStale;
  }
  const double due = settings_.is_on ? now + std::max(wait_ - lateness, 0.0) : now;
  if (waiting_.size() == settings_.room) {
    // Latest wins: the oldest packet is replaced.
    ++counts_.full;
    const auto oldest = std::min_element(
        waiting_.begin(), waiting_.end(),
        [](const Waiting& a, const Waiting& b) { return a.packet.sequence < b.packet.sequence; });
    if (packet.sequence < oldest->packet.sequence) return Verdict::kFull;
    *oldest = {packet, due};
    return Verdict::kWaits;
  }
  waiting_.push_back({packet, due});
  return Verdict::kWaits;
}

std::optional<Arrival> Playout::pop(double from, double until) noexcept {
  for (;;) {
    const auto next =
        std::min_element(waiting_.begin(), waiting_.end(), [](const Waiting& a, const Waiting& b) {
          return a.due != b.due ? a.due < b.due : a.packet.sequence < b.packet.sequence;
        });
    if (next == waiting_.end() || !(next->due < until)) return std::nullopt;
    const Waiting due = *next;
    *next = waiting_.back();
    waiting_.pop_back();
    if (isStale(due.packet)) {
      ++counts_.stale;
      continue;
    }
    given_ = due.packet.sequence;
    ++counts_.given;
    return Arrival{due.packet, std::max(due.due, from)};
  }
}

void Playout::clear() noexcept {
  fastest_ = WindowedMinimum(kWindow);
  late_run_.reset();
  remembered_ = 0;
  learnt_ = 0;
  fast_ = kNothing;
  wait_ = jitter_ = 0.0;
  has_begun_ = false;
  given_.reset();
  waiting_.clear();
}

/// True if all packets have been late for a while, and equally so. An emptying queue would make
/// them ever less late; this is a longer route.
bool Playout::isNewRoute(double transit, double now) noexcept {
  if (!late_run_) late_run_ = LateRun{now, transit, transit};
  late_run_->least = std::min(late_run_->least, transit);
  late_run_->most = std::max(late_run_->most, transit);
  if (late_run_->most - late_run_->least > 0.5 * settings_.max_late)
    late_run_ = LateRun{now, transit, transit};
  ++late_run_->late;
  if (now - late_run_->since < kWindow) return false;
  fastest_ = WindowedMinimum(kWindow);
  remembered_ = 0;
  learnt_ = 0;
  fast_ = kNothing;
  late_run_.reset();
  return true;
}

/// Ends the late run once over a quarter of the packets come in time. Single packets that overtake
/// the queue do not end it.
void Playout::noteInTime() noexcept {
  if (!late_run_) return;
  ++late_run_->in_time;
  const auto all = static_cast<double>(late_run_->late + late_run_->in_time);
  if (static_cast<double>(late_run_->in_time) > kQuarter * all) late_run_.reset();
}

bool Playout::isStale(const StatePacket& packet) const noexcept {
  return given_ && packet.sequence <= *given_;
}

void Playout::learn(double transit, double lateness, double now) noexcept {
  if (!has_begun_) {
    has_begun_ = true;
    start_ = last_ = now;
  }
  const std::size_t place = learnt_++ % transits_.size();
  transits_[place] = transit;
  latenesses_[place] = lateness;
  remembered_ = std::min(remembered_ + 1, transits_.size());
  // Sorting costs more than opening a datagram, so it runs rarely once there are enough packets.
  if (remembered_ < kRarely || learnt_ % kRarely == 0) lookAtRemembered();
  const double wanted = std::min(jitter_, settings_.most);
  // The wait may jump at first, when nothing is known and a change disturbs nobody.
  const bool is_new = now - start_ < kSettling;
  const double step = is_new ? settings_.most : settings_.slew * (now - last_);
  wait_ = std::clamp(wanted, wait_ - step, wait_ + step);
  last_ = now;
}

void Playout::lookAtRemembered() noexcept {
  fast_ = findQuantile(transits_, kQuarter);
  jitter_ = std::max(findQuantile(latenesses_, settings_.quantile), 0.0);
}

/// The least value that covers this share of the remembered values.
double Playout::findQuantile(const Remembered& values, double share) noexcept {
  const auto end = std::copy_n(values.begin(), remembered_, sorted_.begin());
  const auto place = static_cast<std::size_t>(std::ceil(share * static_cast<double>(remembered_)));
  const auto at =
      sorted_.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(place, 1) - 1);
  std::nth_element(sorted_.begin(), at, end);
  return *at;
}

}  // namespace tandem
