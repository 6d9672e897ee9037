#include "island/contact_factor.h"

#include <algorithm>
#include <cmath>

namespace tandem {
namespace {

/// Blocks below the diagonal per body: those of a wide pile.
constexpr std::size_t kBlocksPerBody = 16;

/// Changes that leave factors near: of a Jacobian beside its size, and of a stiffness beside its
/// own and beside the largest. Newton's step then removes at least nine tenths of an error. Across
/// sliding, where little moves, nine tenths are enough.
constexpr double kNearJacobian = 1e-5, kNearStiffness = 1e-2, kSmallStiffness = 1e-6;
constexpr double kNearAcross = 1e-1;

bool isNear(const Six& a, const Six& b) noexcept {
  Six change = a;
  change.addScaled(-1.0, b);
  return dot(change, change) <= kNearJacobian * kNearJacobian * dot(b, b);
}

bool isNear(const ContactJacobian& a, const ContactJacobian& b) noexcept {
  if (a.a != b.a || a.b != b.b) return false;
  for (int i = 0; i < 3; ++i) {
    if (!isNear(a.of_a[i], b.of_a[i])) return false;
    if (a.b >= 0 && !isNear(a.of_b[i], b.of_b[i])) return false;
  }
  return true;
}

bool isNear(const ContactStiffness& a, const ContactStiffness& b) noexcept {
  const double largest = std::max({a.nn, b.nn, a.ss, b.ss, a.tt, b.tt});
  const double small = kSmallStiffness * largest;
  const auto near = [&](double x, double y) {
    return std::abs(x - y) <= kNearStiffness * std::abs(y) + small;
  };
  const double across = kNearAcross * std::max(std::abs(b.ss), std::abs(b.tt)) + small;
  return near(a.nn, b.nn) && near(a.sn, b.sn) && near(a.tn, b.tn) &&
         std::abs(a.ss - b.ss) <= across && std::abs(a.st - b.st) <= across &&
         std::abs(a.tt - b.tt) <= across;
}

}  // namespace

ContactFactor::ContactFactor(std::size_t max_bodies, std::size_t most_kept)
    : matrix_(max_bodies, kBlocksPerBody * max_bodies) {
  D_.reserve(most_kept);
}

bool ContactFactor::isNear(const std::vector<ContactStiffness>& D) const noexcept {
  const auto near = [](const ContactStiffness& a, const ContactStiffness& b) {
    return tandem::isNear(a, b);
  };
  return is_made_ && std::equal(D.begin(), D.end(), D_.begin(), D_.end(), near);
}

bool ContactFactor::make(const std::vector<ContactJacobian>& J,
                         const std::vector<ContactStiffness>& D,
                         const std::vector<int>& first) noexcept {
  is_made_ = false;
  if (!matrix_.hasRoomFor(first)) return false;
  matrix_.setIdentity(first);
  for (std::size_t i = 0; i < J.size(); ++i)
    if (!(D[i] == ContactStiffness())) add(J[i], D[i]);
  if (!matrix_.factorise()) return false;
  if (D.size() > D_.capacity()) return true;
  D_.assign(D.begin(), D.end());
  return is_made_ = true;
}

/// Adds J^T D J.
void ContactFactor::add(const ContactJacobian& J, const ContactStiffness& D) noexcept {
  const auto multiply = [&](const Six(&along)[3], Six(&result)[3]) {
    result[0] = along[0].scaled(D.nn);
    result[1] = combine(D.sn, D.ss, D.st, along);
    result[2] = combine(D.tn, D.st, D.tt, along);
  };
  const auto addTo = [](SixBySix& to, const Six(&along)[3], const Six(&stiff)[3]) {
    for (int c = 0; c < 6; ++c)
      to.column[c].add(combine(stiff[0].at[c], stiff[1].at[c], stiff[2].at[c], along));
  };
  Six D_a[3], D_b[3];
  multiply(J.of_a, D_a);
  addTo(matrix_.diagonal(J.a), J.of_a, D_a);
  if (J.b < 0) return;
  multiply(J.of_b, D_b);
  addTo(matrix_.diagonal(J.b), J.of_b, D_b);
  if (J.a > J.b) {
    addTo(matrix_.lower(J.a, J.b), J.of_a, D_b);
    addTo(matrix_.upper(J.b, J.a), J.of_b, D_a);
  } else {
    addTo(matrix_.lower(J.b, J.a), J.of_b, D_a);
    addTo(matrix_.upper(J.a, J.b), J.of_a, D_b);
  }
}

GroupShape::GroupShape(std::size_t max_bodies, std::size_t most_kept) {
  J_.reserve(most_kept);
  first_.reserve(max_bodies);
}

bool GroupShape::isNear(const std::vector<ContactJacobian>& J,
                        const std::vector<int>& first) const noexcept {
  const auto near = [](const ContactJacobian& a, const ContactJacobian& b) {
    return tandem::isNear(a, b);
  };
  return first == first_ && std::equal(J.begin(), J.end(), J_.begin(), J_.end(), near);
}

void GroupShape::keep(const std::vector<ContactJacobian>& J,
                      const std::vector<int>& first) noexcept {
  const bool has_room = J.size() <= J_.capacity();
  J_.assign(J.begin(), has_room ? J.end() : J.begin());
  first_.assign(first.begin(), first.end());
}

}  // namespace tandem
