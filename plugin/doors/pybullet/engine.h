#pragma once

#include <optional>
#include <vector>

#include "tandem/tandem.h"

#include "b3_functions.h"

namespace tandem::pybullet {

/// Properties of a body's base besides its state.
struct BodyFacts {
  double mass = 0.0;    // [kg]; 0: static
  double inertia[3]{};  // principal moments [kg m^2]
  double friction = 0.0;
  // These are 0 for a btRigidBody: unknown to PyBullet's interface.
  double restitution = 0.0;
  double rolling_friction = 0.0, spinning_friction = 0.0;  // [m]
  double linear_damping = 0.0;  // v (1 - d)^dt, or -m d v for a multibody
  double angular_damping = 0.0;
  double contact_threshold = 0.0;  // [m]; 0 for a btRigidBody: unknown, too
  bool is_multibody = true;        // else a btRigidBody, "maximal coordinates", or soft
  bool is_soft = false;
  bool has_soft_contact = false;  // contact stiffness of its own
  bool may_sleep = false;
  int links = 0;  // besides the base
};

/// Length of PyBullet's next internal step [s], and its gravity [m/s^2].
struct EngineParameters {
  double step = 0.0;
  double gravity[3]{};
};

/// PyBullet's physics server through its C interface. Queries return nothing if the body does not
/// exist. Allowed in commands and in ticks, but not in exitPlugin(): the bodies may be deleted
/// there, and PyBullet would access them. Thread: the server's.
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
  void writeContactThreshold(int body, double distance) const;
  void letSleep(int body, bool may_sleep) const;

  /// Switches contact between the bases of two bodies, whatever their groups and masks.
  void setCollides(int body_a, int body_b, bool collides) const;

  std::optional<EngineParameters> readParameters() const;

  /// Shape pieces of a multibody's base. PyBullet does not tell those of a btRigidBody.
  std::vector<b3::CollisionShapeData> readShape(int body) const;

 private:
  B3Functions b3_;
  b3::Client client_;
};

}  // namespace tandem::pybullet
