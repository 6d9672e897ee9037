#include "island/overlap_allowance.h"

#include <algorithm>

namespace tandem {
namespace {

/// Bounds of a new pair's allowed overlap [m]: less is rounding, more is moved out.
constexpr double kLeast = 1e-6, kMost = 5e-4;
constexpr double kFar = 1.0;  // [m]

}  // namespace

void OverlapAllowance::begin() noexcept {
  for (Pair& pair : pairs_) {
    pair.seen = false;
    pair.least = kFar;
  }
}

const OverlapAllowance::Pair* OverlapAllowance::find(const RigidContact& contact) const noexcept {
  const auto is_it = [&](const Pair& pair) { return pair.a == contact.a && pair.b == contact.b; };
  if (hint_ < pairs_.size() && is_it(pairs_[hint_])) return &pairs_[hint_];
  const auto found = std::find_if(pairs_.begin(), pairs_.end(), is_it);
  if (found == pairs_.end()) return nullptr;
  hint_ = static_cast<std::size_t>(found - pairs_.begin());
  return &*found;
}

void OverlapAllowance::look(const RigidContact& contact, double at_start) noexcept {
  auto* pair = const_cast<Pair*>(find(contact));
  if (pair == nullptr) {
    if (pairs_.size() == pairs_.capacity()) return;
    pairs_.push_back({contact.a, contact.b, true, false, 0.0, kFar});
    pair = &pairs_.back();
  }
  pair->seen = true;
  pair->least = std::min(pair->least, pair->is_new ? at_start : contact.distance);
}

void OverlapAllowance::end() noexcept {
  for (Pair& pair : pairs_) {
    if (pair.is_new) {
      pair.overlap = pair.least < -kLeast ? std::max(pair.least, -kMost) : 0.0;
    } else {
      pair.overlap = std::min(0.0, std::max(pair.overlap, pair.least));
    }
    pair.is_new = false;
  }
  std::erase_if(pairs_, [](const Pair& pair) { return !pair.seen; });
}

double OverlapAllowance::overlapOf(const RigidContact& contact) const noexcept {
  const Pair* pair = find(contact);
  return pair ? pair->overlap : 0.0;
}

}  // namespace tandem
