#include "site/membership.h"

#include <algorithm>

namespace tandem {

Membership::Membership(PeerId self, const MembershipSettings& settings) noexcept
    : self_(self), settings_(settings) {
  alone_.add(self);
  heard_ = members_ = alone_;
}

void Membership::hear(PeerId peer, const std::optional<RollCall>& roll, double time) noexcept {
  if (!roll || peer == self_ || static_cast<std::uint32_t>(peer) - 1 >= kMaxPeerId) return;
  others_[static_cast<std::uint32_t>(peer) - 1] = {*roll, time};
  heard_.add(peer);
}

void Membership::forget(PeerId peer) noexcept {
  if (peer != self_) heard_.remove(peer);
}

bool Membership::agree(double now) noexcept {
  if (!begun_at_) begun_at_ = now;
  forEachHeard([&](PeerId peer) {
    if (now - of(peer).heard_at > settings_.leave_after) heard_.remove(peer);
  });
  if (heard_ == members_ || !isAgreed()) return false;
  const bool was_alone = members_ == alone_;
  members_ = heard_;
  if (was_alone) leader_ = findLeader(now);
  if (leader_ && !members_.has(*leader_)) leader_.reset();
  return true;
}

bool Membership::isTied(PeerId peer, bool was_tied) const noexcept {
  if (!follows()) return true;
  return (was_tied || members_.has(peer)) && of(peer).roll.members.has(self_);
}

std::optional<RollCall> Membership::tell(double now) const noexcept {
  if (!follows()) return std::nullopt;
  return RollCall{heard_, leader_ ? alone_ : members_, computeAge(now)};
}

double Membership::computeAge(double now) const noexcept {
  return begun_at_ ? std::max(0.0, now - *begun_at_) : 0.0;
}

const Membership::Other& Membership::of(PeerId peer) const noexcept {
  return others_[static_cast<std::uint32_t>(peer) - 1];
}

/// True if all that are heard hear the same.
bool Membership::isAgreed() const noexcept {
  bool is_same = true;
  forEachHeard([&](PeerId peer) { is_same &= of(peer).roll.heard == heard_; });
  return is_same;
}

/// The lowest of those who are together already; if nobody is, the oldest of all. Ages are told a
/// delay ago. So of two that began in the same moment none may follow the other.
std::optional<PeerId> Membership::findLeader(double now) const noexcept {
  std::optional<PeerId> oldest, of_group;
  double most = computeAge(now);
  forEachHeard([&](PeerId peer) {
    const Other& other = of(peer);
    if (!of_group && other.roll.members.count() > 1) of_group = peer;
    const double age = other.roll.age + (now - other.heard_at);
    if (age <= most) return;
    most = age;
    oldest = peer;
  });
  return of_group ? of_group : oldest;
}

/// In rising order.
template <typename Visit>
void Membership::forEachHeard(Visit visit) const noexcept {
  for (std::uint32_t id = 1; id <= kMaxPeerId; ++id)
    if (const PeerId peer{id}; peer != self_ && heard_.has(peer)) visit(peer);
}

}  // namespace tandem
