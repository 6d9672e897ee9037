#include "c/mesh_link.h"

#include <algorithm>
#include <cmath>

namespace tandem::c_door {
namespace {

/// Fraction of a change that the clock offset follows per update. The two clocks are read at
/// different moments, so their difference jitters by a host step or a tick.
constexpr double kFollow = 0.05;
/// A larger difference is no jitter: a clock was set, or time was lost [s].
constexpr double kJump = 0.1;

/// A live site gets arrivals this long before their time, from a caller that polls at 50 Hz or more
/// [s].
constexpr double kAhead = 0.02;

}  // namespace

void MeshWay::setClock(double clock) noexcept {
  clock_ = clock;
  is_clock_new_ = true;
}

void MeshWay::setSiteTime(double time) noexcept {
  is_clock_new_ = false;
  const double now_ahead = clock_ - time;
  if (!ahead_ || std::abs(now_ahead - *ahead_) > kJump) ahead_ = now_ahead;
  *ahead_ += kFollow * (now_ahead - *ahead_);
}

std::optional<Arrival> MeshWay::receive(double from, double until) noexcept {
  if (is_clock_new_) setSiteTime(from);
  if (!ahead_) return std::nullopt;  // the mesh has not been polled yet
  std::optional<Arrival> arrival = way_.receive(from + *ahead_, until + *ahead_);
  if (arrival) arrival->time = std::max(arrival->time - *ahead_, from);
  return arrival;
}

void MeshLink::setLive(bool is_live) noexcept {
  has_ticked_.store(false, std::memory_order_relaxed);
  is_live_ = is_live;
}

void MeshLink::poll(double clock) noexcept {
  way_.setClock(clock);
  if (!is_live_ || !has_ticked_.load(std::memory_order_acquire)) return;
  way_.setSiteTime(site_time_.load(std::memory_order_relaxed));
  queue_.exchange(way_, way_.siteTime(), way_.siteTime() + kAhead);
}

void MeshLink::send(const StatePacket& packet, double now) noexcept {
  if (is_live_) return queue_.send(packet, now);
  way_.send(packet, now);
}

std::optional<Arrival> MeshLink::receive(double from, double until) noexcept {
  if (!is_live_) return way_.receive(from, until);
  site_time_.store(from, std::memory_order_relaxed);
  has_ticked_.store(true, std::memory_order_release);
  return queue_.receive(from, until);
}

}  // namespace tandem::c_door
