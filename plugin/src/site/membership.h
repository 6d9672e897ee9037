#pragma once

#include <array>
#include <optional>

#include "tandem/coordination/site_set.h"
#include "tandem/plugin/site_settings.h"

namespace tandem {

// clang-format off
/// Agrees with the peers on who takes part, without anybody in charge. Each site tells the others
/// in every packet whom it hears.
///
///     all that are heard hear exactly the same   they are the members, at each of them
///     those of the members that are heard do     the others have left, whoever else is heard
///     a peer says farewell, or is long silent    it is heard no more
///     one is alone and meets others              it joins: it takes over their objects first
///
/// News takes a packet each way, so that sites differ for a moment. A pair is tied while each counts
/// the other. If some members do not hear each other, the members stay as they were.
///
/// Who joins follows one of the others, and chooses anew while that one does not count it. So no
/// two follow each other: ages are told rounded down, so of two only the younger may follow.
///
/// Plain value without a clock; real-time safe.
// clang-format on
class Membership {
 public:
  Membership(PeerId self, const MembershipSettings& settings) noexcept;

  /// False: everybody counts, and the number of sites is fixed.
  [[nodiscard]] bool follows() const noexcept { return settings_.follows; }

  /// A peer tells whom it hears, at `time` [s]; empty: it has another way, and never counts.
  void hear(PeerId peer, const std::optional<RollCall>& roll, double time) noexcept;
  /// A peer has left.
  void forget(PeerId peer) noexcept;
  /// Forgets peers that have been silent for too long at `now` [s], and chooses whom to follow.
  /// True if the members are others now.
  bool agree(double now) noexcept;

  /// True if the peer and this site count each other, or did when it was heard last: a peer that
  /// leaves fades. `was_tied`: the same was true until now.
  [[nodiscard]] bool isTied(PeerId peer, bool was_tied) const noexcept;
  /// N.
  [[nodiscard]] int count() const noexcept { return members_.count(); }
  /// The member whose copies this site takes over; empty if it joins nobody.
  [[nodiscard]] const std::optional<PeerId>& leader() const noexcept { return leader_; }
  /// It has taken them over, or nothing of them comes.
  void endJoin() noexcept { leader_.reset(); }
  /// What the others are told at `now` [s]. A site that joins counts nobody until its copies have
  /// come over.
  [[nodiscard]] std::optional<RollCall> tell(double now) const noexcept;

 private:
  /// A peer, by its id.
  struct Other {
    RollCall roll;          ///< its newest
    double heard_at = 0.0;  ///< [s]
  };

  [[nodiscard]] const Other& of(PeerId peer) const noexcept;
  [[nodiscard]] SiteSet findMembers() const noexcept;
  [[nodiscard]] bool doAllHear(SiteSet part) const noexcept;
  [[nodiscard]] bool mayLead(PeerId peer, double now) const noexcept;
  [[nodiscard]] bool isLed(double now) const noexcept;
  [[nodiscard]] std::optional<PeerId> findLeader(double now) const noexcept;
  [[nodiscard]] double computeAge(double now) const noexcept;
  template <typename Visit>
  void forEachHeard(SiteSet part, Visit visit) const noexcept;

  PeerId self_;
  MembershipSettings settings_;
  SiteSet alone_;            ///< this site
  SiteSet heard_, members_;  ///< with this site
  std::optional<PeerId> leader_;
  std::optional<double> begun_at_;  ///< [s]
  std::array<Other, kMaxPeerId> others_;
};

}  // namespace tandem
