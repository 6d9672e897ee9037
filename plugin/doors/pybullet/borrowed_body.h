#pragma once

#include <string>

#include "tandem/coordination/types.h"

#include "engine.h"

namespace tandem::pybullet {

/// A body of PyBullet while Tandem has a hand on it: mass, damping and sleeping as Tandem needs
/// them, and what they were.
///
/// PyBullet gives the number of a removed body to the next one that is made. So a borrowed body
/// carries marks that no other has: two dampings too small (1e-30) to damp anything, and the low
/// bits (1e-7) of friction and, where PyBullet tells it, restitution. The user may set any of these
/// meanwhile: as long as one mark is left it is the same body.
class BorrowedBody {
 public:
  /// Reads only. Throws Refusal if there is no such body.
  BorrowedBody(const Engine& engine, int body);

  int number() const { return body_; }
  const BodyFacts& before() const { return before_; }

  /// No damping, no sleep, the marks, and `share` of mass and inertia. 0: they stay as they are.
  void borrow(const Engine& engine, double share);

  /// Whether the body still is the one that was borrowed. A damping or mass that the user has given
  /// it meanwhile is taken off again, friction and restitution stay; `notice` tells of each.
  /// Damping, friction and restitution of the user's are what giveBack() gives.
  bool isThere(const Engine& engine, std::string& notice);

  /// Puts back what borrow() has changed; false if it is not the same body any more.
  bool giveBack(const Engine& engine);

  /// The velocities to hand over so that those of `target` come out of PyBullet's step.
  void makeReadyToTurn(double step, TandemState& target) const;

 private:
  struct Marks {
    bool linear_damping, angular_damping, friction, restitution;
  };
  Marks findMarks(const BodyFacts& facts) const;
  void putMarks(const Engine& engine) const;
  void renewMarks(const Engine& engine, const BodyFacts& facts, const Marks& has,
                  std::string& notice);

  int body_;
  BodyFacts before_;
  double mark_ = 0.0;
  double mass_ = 0.0;      // in PyBullet meanwhile
  Vec3 inertia_{0, 0, 0};  // the same
};

}  // namespace tandem::pybullet
