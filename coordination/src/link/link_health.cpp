#include "link/link_health.h"

#include <algorithm>
#include <cmath>

#include "tandem/coordination/link.h"

#include "bad_value.h"

namespace tandem {
namespace {

/// Number of missing packets in a row that makes a peer stale.
constexpr double kPacketsToBeStale = 3.0;

}  // namespace

std::string_view nameOf(LinkState state) noexcept {
  switch (state) {
    case LinkState::kWaiting:
      return "waiting";
    case LinkState::kLive:
      return "live";
    case LinkState::kStale:
      return "stale";
    case LinkState::kFading:
      return "fading";
    case LinkState::kLost:
      return "lost";
    case LinkState::kRejoining:
      break;
  }
  return "rejoining";
}

void checkLinkLossSettings(const LinkLossSettings& s) {
  const auto check = [](const char* name, double value, bool is_good, const char* allowed) {
    if (!is_good || !std::isfinite(value)) throwBadValue(name, value, allowed);
  };
  check("link_loss.stale_after", s.stale_after, s.stale_after > 0.0, "a finite number > 0");
  check("link_loss.fade_after", s.fade_after, s.fade_after >= s.stale_after,
        "finite, at least stale_after");
  check("link_loss.lost_after", s.lost_after, s.lost_after > s.fade_after,
        "finite, more than fade_after");
  check("link_loss.hold_decay", s.hold_decay, s.hold_decay > 0.0, "a finite number > 0");
  check("link_loss.ramp_in", s.ramp_in, s.ramp_in > 0.0, "a finite number > 0");
  check("link_loss.rejoin_overlap", s.rejoin_overlap, s.rejoin_overlap >= 0.0,
        "a finite number >= 0");
}

double computeRestDamping(const CouplerGains& gains, double mass, double decay) noexcept {
  return std::max({gains.damping, 2.0 * std::sqrt(gains.stiffness * mass), mass / decay});
}

LinkHealth::LinkHealth(const LinkLossSettings& settings, double packet_period) noexcept
    : settings_(settings), packet_period_(packet_period) {
  scaleAges(packet_period);
  if (settings.enabled && !settings.start_live) await();
}

void LinkHealth::await() noexcept {
  heard_.reset();
  state_ = LinkState::kWaiting;
  is_out_ = true;
  fade_ = 1.0;
  object_ramp_.from = proxy_ramp_.from = object_share_ = proxy_share_ = 0.0;
}

void LinkHealth::scaleAges(double packet_period) noexcept {
  scale_ = std::max(1.0, kPacketsToBeStale * packet_period / settings_.stale_after);
  stale_after_ = scale_ * settings_.stale_after;
}

double LinkHealth::computeAge(double time) const noexcept {
  return heard_ ? std::max(0.0, time - *heard_) : 0.0;
}

bool LinkHealth::isOverdue(double time) const noexcept {
  return settings_.enabled && computeAge(time) >= stale_after_;
}

bool LinkHealth::hear(double time, bool is_idle) noexcept {
  if (!settings_.enabled) return false;
  if (!staysLive(time)) look(time);
  const bool comes_back = state_ == LinkState::kWaiting || state_ == LinkState::kLost;
  if (comes_back) {
    ++counters_.rejoined;
    object_ramp_ = {0.0, time};
  } else {
    object_ramp_ = {object_share_, time};
    proxy_ramp_ = {proxy_share_, time};
  }
  heard_ = time;
  scaleAges(is_idle ? std::max(kIdlePacketPeriod, packet_period_) : packet_period_);
  look(time);
  return comes_back;
}

void LinkHealth::update(double time, bool place_is_free) noexcept {
  if (!settings_.enabled || staysLive(time)) return;
  look(time);
  if (!is_out_ || state_ != LinkState::kRejoining || !place_is_free) return;
  is_out_ = false;
  proxy_ramp_ = {0.0, time};
}

void LinkHealth::look(double time) noexcept {
  if (!heard_) return;
  const double age = computeAge(time);
  const double fade_after = scale_ * settings_.fade_after;
  const double lost_after = scale_ * settings_.lost_after;
  const LinkState before = state_;
  if (age > lost_after) {
    state_ = LinkState::kLost;
    is_out_ = true;
    fade_ = velocity_share_ = object_share_ = proxy_share_ = 0.0;
    if (before != LinkState::kLost) ++counters_.lost;
    return;
  }
  fade_ = age > fade_after ? (lost_after - age) / (lost_after - fade_after) : 1.0;
  velocity_share_ =
      age > stale_after_ ? std::exp(-(age - stale_after_) / settings_.hold_decay) : 1.0;
  const double ramped_until = std::min(time, *heard_ + stale_after_);
  object_share_ = fade_ * valueOf(object_ramp_, ramped_until);
  proxy_share_ = is_out_ ? 0.0 : fade_ * valueOf(proxy_ramp_, ramped_until);
  if (age < stale_after_) {
    const bool is_whole = object_share_ == 1.0 && proxy_share_ == 1.0;
    state_ = is_whole ? LinkState::kLive : LinkState::kRejoining;
  } else {
    state_ = age < fade_after ? LinkState::kStale : LinkState::kFading;
  }
  if (state_ == LinkState::kFading && before != LinkState::kFading) ++counters_.faded;
}

double LinkHealth::valueOf(const Ramp& ramp, double time) const noexcept {
  if (ramp.from >= 1.0) return 1.0;
  return std::min(1.0, ramp.from + std::max(0.0, time - ramp.since) / settings_.ramp_in);
}

}  // namespace tandem
