#pragma once

#include <cstddef>
#include <vector>

#include "island/contact_finder.h"

namespace tandem {

/// Effect of a rigid contact point in a host step.
struct ContactSum {
  RigidContact contact;           ///< as last seen
  Vec3 impulse_W = Vec3::Zero();  ///< on body a over the step [N s]
  bool rests = false;             ///< both bodies rest on each other from now on
};

/// Adds up the impulses of rigid contact points from one end of a host step to the next, for a host
/// that wants to see them.
///
/// A point whose bodies came to rest is reported once more, with what a whole step of its force
/// gives. Then it is left out: at rest nothing is solved, so nothing changes. All functions are
/// real-time safe, and cost nothing while nothing is counted.
class ContactTally {
 public:
  /// Allocates.
  explicit ContactTally(std::size_t capacity);

  /// Before an advance, or before it is repeated: what was counted in it is forgotten.
  void startAdvance() noexcept;
  void endAdvance() noexcept;

  /// All positions were shifted.
  void shiftOrigin(const Vec3& offset_W) noexcept {
    for (Entry& entry : entries_) entry.sum.contact.p_W += offset_W;
    for (ContactSum& sum : report_) sum.contact.p_W += offset_W;
  }

  /// @name For each inner step.
  /// @{
  void startStep(double h) noexcept;
  void count(const RigidContact& contact, const Vec3& impulse_W) noexcept;
  /// @}

  /// Ends a host step of `duration` [s]. `is_still(body)`: nothing moves the body now.
  template <typename IsStill>
  void cut(double duration, IsStill is_still) noexcept {
    if (has_been_taken_) report_.clear();
    has_been_taken_ = false;
    std::size_t kept = 0;
    for (Entry& entry : entries_) {
      const RigidContact& contact = entry.sum.contact;
      entry.sum.rests = is_still(contact.a) && (contact.b == kStanding || is_still(contact.b));
      if (entry.sum.rests) entry.sum.impulse_W = duration * entry.f_W;
      add(entry.sum);
      entry.sum.impulse_W.setZero();
      if (!entry.sum.rests && entry.step == step_) entries_[kept++] = entry;
    }
    entries_.resize(kept);
  }

  /// Points of the host steps since the last call. Valid until the next cut().
  [[nodiscard]] const std::vector<ContactSum>& take() noexcept {
    if (has_been_taken_) report_.clear();
    has_been_taken_ = true;
    return report_;
  }

 private:
  struct Entry {
    ContactSum sum;
    Vec3 in_advance_W = Vec3::Zero();  ///< impulse of the advance that runs [N s]
    Vec3 f_W = Vec3::Zero();           ///< force in the last inner step [N]
    std::size_t step = 0;              ///< in which it was last counted
  };
  [[nodiscard]] static bool isSame(const RigidContact& x, const RigidContact& y) noexcept;
  void add(const ContactSum& sum) noexcept;

  std::vector<Entry> entries_;
  std::vector<ContactSum> report_;
  std::size_t step_ = 0;  ///< number of the inner step
  std::size_t next_ = 0;  ///< place of the entry after the last match
  double h_ = 0.0;
  bool has_been_taken_ = false;
};

}  // namespace tandem
