#pragma once

#include <array>
#include <cstddef>

#include "coordination/src/island/joint_source.h"

namespace tandem {

/// Ways of one body that joints with another body hold already: up to six.
///
/// Two pins between the same bodies hold their distance twice. While they are open, the rows of
/// both contradict each other in that direction, and would lock the hinge that the pins are: the
/// axes through the pins differ on the two bodies. On one body alone what is held twice is exact,
/// however open the joints are. Plain value; real-time safe.
class HeldWays {
 public:
  /// Adds what a locked row holds. False if all of that is held already. `of_a`: look at the row's
  /// part of end a, else at that of b.
  bool add(const JointRow& row, bool of_a) noexcept;

 private:
  using Way = Eigen::Matrix<double, 6, 1>;

  std::array<Way, 6> held_ = {};  ///< orthonormal
  std::size_t count_ = 0;
};

}  // namespace tandem
