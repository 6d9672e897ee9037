#include "site/membership.h"

#include <algorithm>

namespace tandem {
namespace {

/// Another leads once a leader has been silent for so long [s].
constexpr double kMostSilence = 1.0;
/// Who is older by less than this is of the same age [s].
constexpr double kSameAge = 1e-6;

}  // namespace

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
  forEachHeard(heard_, [&](PeerId peer) {
    if (now - of(peer).heard_at > settings_.leave_after) heard_.remove(peer);
  });
  const SiteSet before = members_;
  members_ = findMembers();
  const bool has_changed = members_ != before;
  const bool joins = leader_ || (has_changed && before == alone_);
  if (joins && !isLed(now)) leader_ = findLeader(now);
  return has_changed;
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

/// Those who are heard, if they agree; else those of the members who are. Who left counts no more,
/// though a newcomer is not heard by all.
SiteSet Membership::findMembers() const noexcept {
  if (heard_ == members_) return members_;
  for (const SiteSet part : {SiteSet::all(), members_})
    if (doAllHear(part)) return heard_ & part;
  return members_;
}

/// True if all of `part` that are heard hear the same part of it.
bool Membership::doAllHear(SiteSet part) const noexcept {
  bool is_same = true;
  forEachHeard(heard_ & part,
               [&](PeerId peer) { is_same &= (of(peer).roll.heard & part) == (heard_ & part); });
  return is_same;
}

bool Membership::mayLead(PeerId peer, double now) const noexcept {
  return members_.has(peer) && now - of(peer).heard_at <= kMostSilence;
}

/// True if it follows one of the others, who counts it.
bool Membership::isLed(double now) const noexcept {
  return leader_ && mayLead(*leader_, now) && of(*leader_).roll.members.has(self_);
}

/// The lowest of those who are together already; if nobody is, the oldest of all. Ages are told a
/// delay ago. So of two that began in the same moment none may follow the other.
std::optional<PeerId> Membership::findLeader(double now) const noexcept {
  std::optional<PeerId> oldest, of_group;
  double most = computeAge(now) + kSameAge;
  forEachHeard(members_, [&](PeerId peer) {
    if (!mayLead(peer, now)) return;
    const Other& other = of(peer);
    if (!of_group && other.roll.members.count() > 1) of_group = peer;
    const double age = other.roll.age + (now - other.heard_at);
    if (age <= most) return;
    most = age;
    oldest = peer;
  });
  return of_group ? of_group : oldest;
}

/// Visits the others of `part` in rising order.
template <typename Visit>
void Membership::forEachHeard(SiteSet part, Visit visit) const noexcept {
  for (std::uint32_t id = 1; id <= kMaxPeerId; ++id)
    if (const PeerId peer{id}; peer != self_ && part.has(peer)) visit(peer);
}

}  // namespace tandem
