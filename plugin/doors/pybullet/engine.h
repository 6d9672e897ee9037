#pragma once

#include <optional>
#include <vector>

#include "tandem/tandem.h"

#include "b3_functions.h"

namespace tandem::pybullet {

/// What PyBullet knows of a body's base besides its state.
struct BodyFacts {
  double mass = 0.0;    // [kg]; 0: static
  double inertia[3]{};  // principal moments [kg m^2]
  double friction = 0.0;
  double restitution = 0.0;     // 0 for a btRigidBody: PyBullet does not tell
  double linear_damping = 0.0;  // v (1 - d)^dt, or -m d v for a multibody
  double angular_damping = 0.0;
  bool is_multibody = true;  // else a btRigidBody, "maximal coordinates"
  bool may_sleep = false;
  int links = 0;  // besides the base
};

/// Time step of PyBullet's next internal step [s], and what it adds to velocities [m/s^2].
struct EngineParameters {
  double step = 0.0;
  double gravity[3]{};
};

/// PyBullet's physics server, seen through its C interface. What asks for a body gives nothing when
/// there is none. May be used in commands and in ticks, not in exitPlugin(): there the bodies may
/// have been deleted, and PyBullet would reach for them. Thread: the server's.
class Engine {
 public:
  Engine(const B3Functions& functions, b3::Client client) : b3_(functions), client_(client) {}

  /// Pose of the centre of mass and velocities of the base.
  bool readState(int body, TandemState& state) const;
  void writeVelocities(int body, const TandemState& state) const;
  void writeState(int body, const TandemState& state) const;

  std::optional<BodyFacts> readFacts(int body) const;
  void writeMass(int body, double mass, const double inertia[3]) const;
  void writeDamping(int body, double linear, double angular) const;
  void writeFriction(int body, double friction) const;
  void writeRestitution(int body, double restitution) const;
  void letSleep(int body, bool may_sleep) const;

  /// Whether the bases of two bodies collide from now on, whatever their groups and masks.
  void setCollides(int body_a, int body_b, bool collides) const;

  std::optional<EngineParameters> readParameters() const;

  /// Pieces of the shape of the base of a multibody. PyBullet tells nothing of a btRigidBody's.
  std::vector<b3::CollisionShapeData> readShape(int body) const;

 private:
  B3Functions b3_;
  b3::Client client_;
};

}  // namespace tandem::pybullet
