#include "joints/held_ways.h"

#include <cmath>

namespace tandem {
namespace {

/// Part of a row's square that is new at least.
constexpr double kNew = 1e-5;
/// Lever by which turns count as much as ways [m]. Pins that are a millimetre apart still hold a
/// turn.
constexpr double kLever = 0.1;

}  // namespace

bool HeldWays::add(const JointRow& row, bool of_a) noexcept {
  Way way;
  if (of_a)
    way << row.n_W, row.turn_a_W / kLever;
  else
    way << -row.n_W, row.turn_b_W / kLever;
  way.normalize();
  for (std::size_t i = 0; i < count_; ++i) way -= held_[i].dot(way) * held_[i];
  const double rest = way.squaredNorm();
  if (count_ == held_.size() || !(rest > kNew)) return false;
  held_[count_++] = way / std::sqrt(rest);
  return true;
}

}  // namespace tandem
