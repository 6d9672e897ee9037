#include "bench/account/island_watch.h"

#include <algorithm>
#include <limits>

namespace tandem::demos::bench {
namespace {

/// Bits of the sequence number between two real packets, for repeated ones.
constexpr unsigned kRepeatBits = 24;

constexpr double kNever = std::numeric_limits<double>::infinity();

std::uint64_t spread(std::uint64_t sequence) { return (sequence + 1) << kRepeatBits; }

}  // namespace

RemoteUser IslandWatch::makeRemoteUser(Island& island, const StandInSettings& stand_in,
                                       const PointState& start) const {
  island_ = &island;
  // The account knows springs only.
  island.setTouchMemory(false);
  const RemoteUser user = scheme_.makeRemoteUser(island, stand_in, start);
  bodies_.push_back(user.body.value_or(-1));
  times_.push_back(0.0);
  return user;
}

void IslandWatch::follow(Island& island, const RemoteUser& user,
                         const PointState& latest) const noexcept {
  const auto known = std::find(bodies_.begin(), bodies_.end(), user.body.value_or(-1));
  const double time = times_[static_cast<std::size_t>(known - bodies_.begin())];
  if (account_) account_->look(time);
  scheme_.follow(island, user, latest);
  if (account_) account_->look(time);
}

WatchedLink::WatchedLink(Link& link, IslandWatch& watch, std::size_t remote,
                         const StatePacket& start, double haptic_period, int most_looks)
    : link_(link),
      watch_(watch),
      remote_(remote),
      latest_(start),
      period_(haptic_period),
      most_looks_(most_looks) {
  latest_.sequence = 0;
}

/// In a tick: looks as often as the account now needs, and each real packet between two looks at
/// the same moment. When this is called again, the last packet has been taken in.
std::optional<Arrival> WatchedLink::receive(double from, double until) noexcept {
  if (from > tick_) {
    tick_ = from;
    stage_ = Stage::kNothing;
    next_look_ = most_looks_ > 0 ? from : kNever;
    is_planned_ = true;
  }
  if (stage_ == Stage::kAfter) {
    stage_ = Stage::kNothing;
    return repeat(time_);
  }
  if (!is_planned_) {
    is_planned_ = true;
    if (most_looks_ > 0 && watch_.account()) {
      const int count = watch_.account()->countLooks(most_looks_);
      next_look_ = count > 1 ? time_ + period_ / count : kNever;
    }
  }
  if (!real_) real_ = link_.receive(from, until);
  if (real_) real_->time = std::max(real_->time, from);
  if (stage_ == Stage::kNothing && next_look_ < until && !(real_ && real_->time < next_look_))
    return repeat(next_look_);
  if (!real_ || real_->time >= until) return std::nullopt;
  if (stage_ == Stage::kNothing) {
    stage_ = Stage::kBefore;
    return repeat(real_->time);
  }
  stage_ = Stage::kAfter;
  Arrival arrival = *real_;
  real_.reset();
  time_ = arrival.time;
  arrival.packet.sequence = spread(arrival.packet.sequence);
  if (arrival.packet.sequence > latest_.sequence) latest_ = arrival.packet;
  watch_.setTime(remote_, arrival.time);
  return arrival;
}

Arrival WatchedLink::repeat(double time) noexcept {
  ++latest_.sequence;
  time_ = time;
  is_planned_ = false;
  watch_.setTime(remote_, time);
  return {latest_, time};
}

}  // namespace tandem::demos::bench
