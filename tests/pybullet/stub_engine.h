#pragma once

#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "tandem/coordination/types.h"

#include "plugin/doors/pybullet/b3_abi.h"

namespace tandem::test {

namespace b3 = pybullet::b3;

/// A body of the stub engine: a base, like PyBullet's multibodies without links.
struct StubBody {
  double mass = 0.2;
  Vec3 inertia = Vec3::Constant(0.2 * 0.04 * 0.04 / 6.0);  // [kg m^2]
  double linear_damping = 0.04, angular_damping = 0.04;    // PyBullet's defaults
  double friction = 0.5, restitution = 0.0;
  double rolling_friction = 0.0, spinning_friction = 0.0;
  double contact_stiffness = -1.0;  // PyBullet's word for none
  double contact_threshold = 1e18;  // [m], Bullet's default
  bool is_multibody = true;
  bool is_soft = false;
  bool may_sleep = true;
  int links = 0;
  RigidState state;
  std::vector<b3::CollisionShapeData> shape;
  Vec3 hit = Vec3::Zero();  // impulse in the next internal step [N s], as of a native contact
  int serial = 0;           // of all that the engine has had; add() sets it
};

class StubContacts;

/// A minimal physics server for a plugin, behind the C functions that the program exports. It does
/// gravity and damping, then x += v dt, or contacts. Each internal step ticks with a context that
/// is zeroed like PyBullet's. Shares no code with the plugin except the layouts.
class StubEngine {
 public:
  double time_step = 1.0 / 240.0;
  int substeps = 0;
  Vec3 gravity = Vec3::Zero();
  bool is_deformable = false;  // its world calls the post-tick before it moves the bodies
  double moves_for = 0.0;      // time that bodies really move for; 0: the step
  std::map<int, StubBody> bodies;
  std::set<std::pair<int, int>> without_contact;
  std::shared_ptr<StubContacts> contacts;  // nothing touches without
  int commands = 0;                        // commands submitted so far

  /// Adds a body. The number of a removed body goes to the next one.
  int add(const StubBody& body);
  void remove(int body) { bodies.erase(body); }
  void reset() { bodies.clear(), without_contact.clear(); }

  b3::Client client() { return reinterpret_cast<b3::Client>(this); }

  using Tick = int (*)(b3::PluginContext*);
  /// stepSimulation(): internal steps with a plugin's ticks around, if there is one.
  void step(Tick pre_tick = nullptr, Tick post_tick = nullptr, void* user_pointer = nullptr);

 private:
  void accelerate(StubBody& body, double dt) const;
  void moveAll(double dt);
  void move(StubBody& body, double dt) const;

  int last_serial_ = 0;
};

/// One piece of a shape as PyBullet reports it for body 0; the caller sets the number.
b3::CollisionShapeData makeStubShape(int geometry, const Vec3& dimensions);

/// The cube of 4 cm and 200 g of the README.
StubBody makeStubCube();
/// A floor that fills all space below z = 0.
StubBody makeStubFloor();

}  // namespace tandem::test
