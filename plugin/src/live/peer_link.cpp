#include "live/peer_link.h"

#include <algorithm>

namespace tandem {

void TimeBridge::setClock(double clock) noexcept {
  clock_before_ = clock_;
  clock_ = clock;
  is_clock_new_ = true;
}

void TimeBridge::noteSiteTime(double time) noexcept {
  is_clock_new_ = false;
  times_.note(clock_, time);
}

void TimeBridge::setSiteTime(double time) noexcept {
  times_.set(clock_ - time);
  stamps_by_site_time_ = true;
}

void TimeBridge::awaitStart() noexcept {
  times_.waitUntilSet();
  shift_ = kBefore;
}

void TimeBridge::sendHeld(const PointState& user, PeerId self) noexcept {
  StatePacket packet;
  packet.sender = self;
  packet.user = user;
  packet.time = knowsSiteTime() ? siteTime() + shift_ : 0.0;
  sendNumbered(packet, clock_);
}

std::optional<TimeBridge::ToldStart> TimeBridge::listenForStart(double delay) noexcept {
  std::optional<ToldStart> told;
  while (const auto arrival = way_.receive(clock_before_, clock_)) {
    if (told || arrival->packet.time == 0.0) continue;
    const double site_time = arrival->packet.time - shift_;
    told = ToldStart{arrival->time - delay - site_time, -site_time};
  }
  return told;
}

void TimeBridge::send(const StatePacket& packet, double now) noexcept {
  StatePacket shifted = packet;
  shifted.time += shift_;
  sendNumbered(shifted, stamps_by_site_time_ ? times_.toClock(now) : clock_);
}

void TimeBridge::sendNumbered(StatePacket packet, double stamp) noexcept {
  packet.sequence = sequence_++;
  way_.send(packet, stamp);
}

std::optional<Arrival> TimeBridge::receive(double from, double until) noexcept {
  if (is_clock_new_) noteSiteTime(from);
  if (!knowsSiteTime()) return std::nullopt;
  for (;;) {
    auto arrival = way_.receive(times_.toClock(from), times_.toClock(until));
    if (!arrival) return std::nullopt;
    if (isHeld(arrival->packet)) continue;  // the peer still counts down
    arrival->packet.time -= shift_;
    arrival->time = std::max(times_.toSite(arrival->time), from);
    return arrival;
  }
}

void PeerLink::setHapticThread(bool has_one) noexcept {
  has_ticked_.store(false, std::memory_order_relaxed);
  has_haptic_thread_ = has_one;
}

void PeerLink::exchange(double ahead) noexcept {
  if (!has_haptic_thread_) return;
  const bool has_ticked = has_ticked_.load(std::memory_order_acquire);
  if (has_ticked) bridge_.noteSiteTime(site_time_.load(std::memory_order_relaxed));
  if (!has_ticked && !bridge_.isSiteTimeSet()) return;
  queue_.exchange(bridge_, bridge_.siteTime(), bridge_.siteTime() + ahead);
}

void PeerLink::send(const StatePacket& packet, double now) noexcept {
  if (has_haptic_thread_) return queue_.send(packet, now);
  bridge_.send(packet, now);
}

std::optional<Arrival> PeerLink::receive(double from, double until) noexcept {
  if (!has_haptic_thread_) return bridge_.receive(from, until);
  site_time_.store(from, std::memory_order_relaxed);
  has_ticked_.store(true, std::memory_order_release);
  return queue_.receive(from, until);
}

bool PeerLink::hasLeft() const noexcept {
  return has_haptic_thread_ ? queue_.hasLeft() : bridge_.hasLeft();
}

}  // namespace tandem
