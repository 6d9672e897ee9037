#pragma once

#include <string>

#include "tandem/coordination/types.h"

#include "engine.h"

namespace tandem::pybullet {

/// A body of PyBullet while Tandem has a hand on it: mass, damping and sleeping as Tandem needs
/// them, and what they were.
///
/// PyBullet gives the number of a removed body to the next one that is made. So a borrowed body
/// carries a mark: a damping that no other has, too small (1e-30) to damp anything.
class BorrowedBody {
 public:
  /// Reads only. Throws Refusal if there is no such body.
  BorrowedBody(const Engine& engine, int body);

  int number() const { return body_; }
  const BodyFacts& before() const { return before_; }

  /// No damping, no sleep, the mark, and `share` of mass and inertia. 0: they stay as they are.
  void borrow(const Engine& engine, double share);

  /// Whether the body still is the one that was borrowed. A damping or mass that the user has given
  /// it meanwhile is taken off again, and told in `notice`; such a damping is what giveBack()
  /// gives.
  bool isThere(const Engine& engine, std::string& notice);

  /// Puts back what borrow() has changed; false if it is not the same body any more.
  bool giveBack(const Engine& engine);

  /// The velocities to hand over so that those of `target` come out of PyBullet's step.
  void makeReadyToTurn(double step, TandemState& target) const;

 private:
  int body_;
  BodyFacts before_;
  double mark_ = 0.0;
  double mass_ = 0.0;      // in PyBullet meanwhile
  Vec3 inertia_{0, 0, 0};  // the same
};

}  // namespace tandem::pybullet
