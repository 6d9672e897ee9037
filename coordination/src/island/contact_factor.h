#pragma once

#include <vector>

#include "island/block_matrix.h"
#include "island/contact_law.h"

namespace tandem {

/// Factors of 1 + J^T D J over the bodies of a group, kept from step to step.
///
/// While contact lasts the matrix hardly changes. Old factors then solve as well: Newton's
/// iteration takes a step more, which costs a tenth of new factors. Real-time safe after the
/// constructor.
class ContactFactor {
 public:
  /// Allocates. Factors of more than `most_kept` laws are used once.
  ContactFactor(std::size_t max_bodies, std::size_t most_kept);

  /// The factors are near nothing any more.
  void forget() noexcept { is_made_ = false; }
  /// True if the factors are of nearly this matrix. The Jacobians are those of make(), or near
  /// (GroupShape).
  [[nodiscard]] bool isNear(const std::vector<ContactStiffness>& D) const noexcept;
  /// Factorises. False: the matrix is singular, or there are too many bodies. `first`: BlockMatrix.
  [[nodiscard]] bool make(const std::vector<ContactJacobian>& J,
                          const std::vector<ContactStiffness>& D,
                          const std::vector<int>& first) noexcept;
  void solve(std::vector<Six>& x) const noexcept { matrix_.solve(x); }

 private:
  void add(const ContactJacobian& J, const ContactStiffness& D) noexcept;

  BlockMatrix matrix_;
  bool is_made_ = false;
  std::vector<ContactStiffness> D_;
};

/// Bodies and Jacobians of a group, as its factors know them. Real-time safe after the constructor.
class GroupShape {
 public:
  /// Allocates. Groups of more than `most_kept` laws are never near.
  GroupShape(std::size_t max_bodies, std::size_t most_kept);

  [[nodiscard]] bool isNear(const std::vector<ContactJacobian>& J,
                            const std::vector<int>& first) const noexcept;
  void keep(const std::vector<ContactJacobian>& J, const std::vector<int>& first) noexcept;

 private:
  std::vector<ContactJacobian> J_;
  std::vector<int> first_;
};

}  // namespace tandem
