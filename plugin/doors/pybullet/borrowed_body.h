#pragma once

#include <string>

#include "tandem/coordination/types.h"

#include "engine.h"

namespace tandem::pybullet {

/// A body of PyBullet while Tandem uses it: its mass, damping and sleeping as Tandem needs them,
/// and their original values.
///
/// PyBullet reuses the number of a removed body. A borrowed body therefore carries unique marks:
/// two dampings too small (1e-30) to damp, and the low bits (1e-7) of friction and, of a multibody,
/// restitution and contact processing threshold. The user may set any of these meanwhile. While one
/// mark is left it is the same body.
class BorrowedBody {
 public:
  enum class Presence {
    kSame,      ///< still the borrowed body
    kChanged,   ///< the same with another mass, inertia or surface: before() has them
    kPinned,    ///< the same, and moves no more: the user has set a mass of 0
    kFreed,     ///< the same, and moves now: the user has set a mass
    kRemoved,   ///< PyBullet has no body of this number
    kUnmarked,  ///< another body, or all marks were overwritten at once
  };

  /// Only reads the body. Throws Refusal if it does not exist or is soft.
  BorrowedBody(const Engine& engine, int body);

  int number() const { return body_; }
  const BodyFacts& before() const { return before_; }

  /// Removes damping and sleeping, sets the marks, and scales mass and inertia by `share`. A
  /// `share` of 0 keeps mass, inertia and sleeping. With `keeps_mass` a mass that the user sets
  /// meanwhile is put back.
  void borrow(const Engine& engine, double share, bool keeps_mass = false);

  /// Looks for what the user has set meanwhile. The body gets its share of a new mass, and keeps a
  /// new surface. A new damping is removed, and acts again after giveBack(). `notice` gets a line
  /// for what Tandem does not follow. Leaves a body without a mark alone, and a pinned or freed one
  /// until giveBack().
  Presence look(const Engine& engine, std::string& notice);

  /// Undoes borrow(). Returns false if this is another body.
  bool giveBack(const Engine& engine);

  /// Changes the velocities so that PyBullet's step ends with those of `target`.
  void makeReadyToTurn(double step, TandemState& target);
  /// Takes out of the state after the step what makeReadyToTurn() could not make up for.
  void leaveOutTurn(TandemState& after) const;

 private:
  struct Marks {
    bool linear_damping, angular_damping, friction, restitution, contact_threshold;
  };
  Marks findMarks(const BodyFacts& facts) const;
  void putMarks(const Engine& engine) const;
  bool renewMarks(const Engine& engine, const BodyFacts& facts, const Marks& has,
                  std::string& notice);
  bool followMass(const Engine& engine, const BodyFacts& facts, std::string& notice);
  bool followRolling(const BodyFacts& facts, std::string& notice);

  int body_;
  BodyFacts before_;
  double mark_ = 0.0;
  double share_ = 0.0;  // of mass and inertia that it has in PyBullet meanwhile; 0: all
  bool keeps_mass_ = false;
  double mass_ = 0.0;      // in PyBullet meanwhile
  Vec3 inertia_{0, 0, 0};  // in PyBullet meanwhile
  Vec3 turn_{0, 0, 0};     // of PyBullet itself, not made up for [rad/s]
};

}  // namespace tandem::pybullet
