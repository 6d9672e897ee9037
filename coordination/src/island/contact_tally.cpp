#include "island/contact_tally.h"

namespace tandem {
namespace {

/// A point that moved by less than this in an inner step is the same point [m].
constexpr double kSameTalliedPoint = 2e-3;

}  // namespace

ContactTally::ContactTally(std::size_t capacity) {
  entries_.reserve(capacity);
  report_.reserve(2 * capacity);
}

bool ContactTally::isSame(const RigidContact& x, const RigidContact& y) noexcept {
  return areOfOnePair(x, y) &&
         (x.p_W - y.p_W).squaredNorm() < kSameTalliedPoint * kSameTalliedPoint;
}

void ContactTally::startAdvance() noexcept {
  for (Entry& entry : entries_) entry.in_advance_W.setZero();
}

void ContactTally::endAdvance() noexcept {
  for (Entry& entry : entries_) {
    entry.sum.impulse_W += entry.in_advance_W;
    entry.in_advance_W.setZero();
  }
}

void ContactTally::startStep(double h) noexcept {
  ++step_;
  next_ = 0;
  h_ = h;
}

void ContactTally::count(const RigidContact& contact, const Vec3& impulse_W) noexcept {
  Entry* found = nullptr;
  for (std::size_t i = 0; i < entries_.size() && found == nullptr; ++i) {
    // Contacts keep much the same order.
    const std::size_t place = (next_ + i) % entries_.size();
    Entry& entry = entries_[place];
    if (entry.step == step_ || !isSame(entry.sum.contact, contact)) continue;
    next_ = place + 1;
    found = &entry;
  }
  if (found == nullptr) {
    if (entries_.size() == entries_.capacity()) return;
    found = &entries_.emplace_back();
  }
  found->sum.contact = contact;
  found->in_advance_W += impulse_W;
  found->f_W = impulse_W / h_;
  found->step = step_;
}

/// Joins points of host steps that nobody asked for yet.
void ContactTally::add(const ContactSum& sum) noexcept {
  for (ContactSum& known : report_) {
    if (!isSame(known.contact, sum.contact)) continue;
    known.contact = sum.contact;
    known.rests = sum.rests;
    known.impulse_W += sum.impulse_W;
    return;
  }
  if (report_.size() < report_.capacity()) report_.push_back(sum);
}

}  // namespace tandem
