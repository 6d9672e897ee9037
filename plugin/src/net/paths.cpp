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
/// The same with a relay: a spare address carries states meanwhile, so several may be lost.
constexpr double kSpareGrace = 0.25;
/// Used while no round trip was measured [s].
constexpr double kUnknownTrip = 0.2;
/// A longer one was measured while the network stood still [s]. A peer may move during a check, so
/// two checks must take less than 10 s.
constexpr double kLongestTrip = 2.0;
/// Copies start a check at most this often, and with a relay checks begin so often [s].
constexpr double kRest = 1.0;
/// A faster address must win so many checks in a row.
constexpr int kWins = 3;
/// The relay must be this much faster than a direct address: another's line is used, too.
constexpr double kFaster = 0.8, kMargin = 2e-3;  // [1], [s]
/// The trip of an address rises by at most this in a check [s].
constexpr double kSlower = 5e-3;
/// An address that answered in this time is a spare one [s].
constexpr double kLately = 3.0;

}  // namespace

Paths::Paths(const std::optional<Address>& configured,
             const std::optional<Address>& relayed) noexcept
    : configured_(configured), relayed_(relayed), in_use_(configured ? configured : relayed) {
  if (configured) hear(*configured);
  if (relayed) hear(*relayed);
}

Paths::Path* Paths::find(const Address& address) noexcept {
  for (auto& path : paths_)
    if (path && path->address == address) return &*path;
  return nullptr;
}

Paths::Calls Paths::calls() const noexcept {
  Calls all{in_use_, configured_, relayed_};
  if (all[1] == all[0]) all[1].reset();
  if (all[2] == all[0] || all[2] == all[1]) all[2].reset();
  return all;
}

std::optional<Address> Paths::spare(double now) const noexcept {
  if (!relayed_) return std::nullopt;
  for (const auto& path : paths_)
    if (path && path->trip && now - path->answered_at < kLately && path->address != in_use_)
      return path->address;
  return std::nullopt;
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
  if (is_checking_ || now < rest_until_) return;
  forgetSilent();
  const auto known = std::count_if(paths_.begin(), paths_.end(), [](auto& one) { return !!one; });
  if (known < 2) return;
  is_checking_ = true;
  since_ = next_ = now;
  wait_ = kFirstWait;
  for (auto& path : paths_)
    if (path)
      *path = {path->address, drawNumber<PathToken>(), false, path->trip, path->answered_at};
}

/// Forgets addresses at which nobody answered the last check.
void Paths::forgetSilent() noexcept {
  for (auto& path : paths_)
    if (path && path->token != 0 && !path->has_answered && !knows(path->address)) path.reset();
}

void Paths::onResponse(PathToken token, double now) noexcept {
  for (auto& path : paths_) {
    if (!path || path->token != token || path->has_answered) continue;
    // A lost challenge makes its answer late, so a slower way is believed in step by step only.
    const double trip = now - since_;
    path->trip = path->trip ? std::min(trip, *path->trip + kSlower) : trip;
    path->has_answered = true;
    path->answered_at = now;
  }
}

Paths::Challenges Paths::advance(double now, double round_trip) noexcept {
  Challenges due;
  if (relayed_) check(now);
  if (!is_checking_) return due;
  const double trip = round_trip > 0.0 ? std::min(round_trip, kLongestTrip) : kUnknownTrip;
  const Path* used = in_use_ ? find(*in_use_) : nullptr;
  if (used && used->has_answered) {
    settle(*used, now);
    return due;
  }
  if (now - since_ > 1.5 * trip + (relayed_ ? kSpareGrace : kGrace))
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

/// The address in use has answered: stays there, unless another has answered faster for a while.
void Paths::settle(const Path& used, double now) noexcept {
  const Path* better = findBetter(used);
  const std::optional<Address> winner = better ? std::optional(better->address) : std::nullopt;
  wins_ = winner && winner == winner_ ? wins_ + 1 : winner ? 1 : 0;
  winner_ = winner;
  if (wins_ >= kWins)
    moveTo(*winner, now);
  else
    finish(now);
}

/// Compares the relay with direct addresses only: of two direct ones the faster may be a
/// listener's.
const Paths::Path* Paths::findBetter(const Path& used) const noexcept {
  const bool is_relayed = relayed_ == used.address;
  for (const auto& path : paths_) {
    if (!path || !path->has_answered || (relayed_ == path->address) == is_relayed) continue;
    const double most = is_relayed ? *used.trip : kFaster * *used.trip - kMargin;
    if (*path->trip <= most) return &*path;
  }
  return nullptr;
}

void Paths::moveTo(const Address& address, double now) noexcept {
  in_use_ = address;
  ++moves_;
  winner_.reset();
  wins_ = 0;
  finish(now);
  rest_until_ = now;
}

void Paths::finish(double now) noexcept {
  is_checking_ = false;
  rest_until_ = now + kRest;
}

}  // namespace tandem::net
