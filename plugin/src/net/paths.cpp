#include "net/paths.h"

#include <algorithm>

#include "net/random.h"

namespace tandem::net {
namespace {

/// Challenges go out at 0, 25, 75, 175, 375 and 775 ms: less than three times the bytes of the
/// state that led to them, wherever they go.
constexpr double kFirstWait = 0.025, kLastWait = 0.8;  // [s]
/// The address in use has this much longer than a round trip and a half to answer [s].
constexpr double kGrace = 0.05;
/// Used while no round trip was measured [s].
constexpr double kUnknownTrip = 0.2;
/// A longer one was measured while the network stood still [s]. A peer may move during a check, so
/// two checks must take less than 10 s.
constexpr double kLongestTrip = 2.0;
/// Copies start a check at most this often [s].
constexpr double kRest = 1.0;

}  // namespace

Paths::Paths(const std::optional<Address>& configured) noexcept
    : configured_(configured), in_use_(configured) {
  if (configured) paths_[0] = Path{*configured};
}

Paths::Path* Paths::find(const Address& address) noexcept {
  for (auto& path : paths_)
    if (path && path->address == address) return &*path;
  return nullptr;
}

void Paths::hear(const Address& from) noexcept {
  if (is_checking_ || find(from)) return;
  for (std::size_t i = 0; i < kMost; ++i) {
    auto& place = paths_[next_place_++ % kMost];
    if (place && knows(place->address)) continue;
    place = Path{from};
    return;
  }
}

void Paths::note(const Address& from, double now) noexcept {
  if (from == in_use_) return;
  hear(from);
  if (in_use_)
    check(now);
  else
    in_use_ = from;
}

void Paths::check(double now) noexcept {
  const auto known = std::count_if(paths_.begin(), paths_.end(), [](auto& one) { return !!one; });
  if (is_checking_ || known < 2 || now < rest_until_) return;
  is_checking_ = true;
  since_ = next_ = now;
  wait_ = kFirstWait;
  for (auto& path : paths_)
    if (path) *path = {path->address, drawNumber<PathToken>(), false};
}

void Paths::onResponse(PathToken token) noexcept {
  for (auto& path : paths_)
    if (is_checking_ && path && path->token == token) path->has_answered = true;
}

Paths::Challenges Paths::advance(double now, double round_trip) noexcept {
  Challenges due;
  if (!is_checking_) return due;
  const double trip = round_trip > 0.0 ? std::min(round_trip, kLongestTrip) : kUnknownTrip;
  const Path* used = in_use_ ? find(*in_use_) : nullptr;
  if (used && used->has_answered) {
    finish(now);
    return due;
  }
  if (now - since_ > 1.5 * trip + kGrace)
    for (const auto& path : paths_)
      if (path && path->has_answered) {
        moveTo(path->address, now);
        return due;
      }
  if (now < next_) return due;
  if (wait_ > kLastWait) {
    // All were sent; the last answers may still be on their way.
    if (now > next_ + trip) finish(now);
    return due;
  }
  next_ = now + wait_;
  wait_ *= 2.0;
  for (std::size_t i = 0; i < kMost; ++i)
    if (paths_[i]) due[i] = Challenge{paths_[i]->address, paths_[i]->token};
  return due;
}

void Paths::moveTo(const Address& address, double now) noexcept {
  in_use_ = address;
  ++moves_;
  finish(now);
  rest_until_ = now;
}

/// Forgets addresses at which nobody answered.
void Paths::finish(double now) noexcept {
  is_checking_ = false;
  rest_until_ = now + kRest;
  for (auto& path : paths_)
    if (path && !path->has_answered && !knows(path->address)) path.reset();
}

}  // namespace tandem::net
