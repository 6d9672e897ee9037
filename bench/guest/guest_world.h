#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <btBulletDynamicsCommon.h>

#include "bench/guest/guest_arm.h"
#include "bench/guest/guest_case.h"
#include "bench/guest/guest_watch.h"
#include "bench/program/draw.h"

namespace tandem::demos::bench {

/// A body of a host, in memory that outlives it: another may be made at its address.
struct GuestBody {
  GuestPlan plan;
  alignas(16) std::byte memory[sizeof(btRigidBody)];
  btRigidBody* rigid = nullptr;  ///< in `memory`
  btCollisionShape* shape = nullptr;
  btDefaultMotionState motion_state;
  double mass = 0.0;  ///< as the host sees it, also while the body is pinned [kg]
  int group = 1, mask = -1;
  bool has_filter = false;  ///< added with group and mask
  bool is_in_world = false;
  bool was_shared = false;
  bool missed_gravity = false;       ///< it slept when the world's gravity changed last
  bool has_unclear_gravity = false;  ///< see GuestWorld::noteGravityOf()
  bool was_added_anew = false;
  bool was_put_to_sleep = false;  ///< by its host, for ever or until something touches it
  bool may_fall = false;          ///< what was done to it may let it fall through what stands
  int gravity_step = -10;         ///< in which the host chose a gravity for it
};

/// A host's world of a case, and what the host does to it. Its twin is another of the same case.
class GuestWorld {
 public:
  explicit GuestWorld(const GuestCase& one);
  ~GuestWorld();
  GuestWorld(const GuestWorld&) = delete;
  GuestWorld& operator=(const GuestWorld&) = delete;

  [[nodiscard]] btDiscreteDynamicsWorld& world() { return *physics_->world; }
  [[nodiscard]] const GuestWatch& watch() const { return *physics_->watch; }
  [[nodiscard]] btVector3 gravity() const { return physics_->world->getGravity(); }
  [[nodiscard]] bool hasWorld() const { return physics_ != nullptr; }
  [[nodiscard]] const std::vector<std::unique_ptr<GuestBody>>& bodies() const { return bodies_; }
  [[nodiscard]] std::vector<std::unique_ptr<btTypedConstraint>>& joints() { return joints_; }
  [[nodiscard]] const std::vector<std::unique_ptr<GuestArm>>& arms() const { return arms_; }
  [[nodiscard]] const GuestCase& plan() const { return case_; }
  [[nodiscard]] btRigidBody& floor() { return *floor_; }
  [[nodiscard]] btScalar floorTop() const;

  /// A body that acts are done to.
  [[nodiscard]] GuestBody& drawBody(Draw& draw);
  [[nodiscard]] GuestBody& drawDynamicBody(Draw& draw);

  /// Sets the gravity of the world.
  void setGravity(const btVector3& g_W);
  /// To be called where the host chooses which gravity a body gets. A site that parks the body
  /// sees both choices at once, if they come within a step: which came last it cannot know.
  void noteGravityOf(GuestBody& body);

  /// Calls stepSimulation() once; movers move first. `pending` is done in the host's own callback
  /// of the first sub-step.
  void step(double time, const std::function<void()>& pending);

  void add(GuestBody& body);
  void remove(GuestBody& body);
  void destroy(GuestBody& body);
  void make(GuestBody& body);
  void setMass(GuestBody& body, double mass);
  /// Before a body goes or stands: Bullet's rows of such a tie read before its list of bodies.
  void removeTiesOf(const GuestBody& body);
  void setShape(GuestBody& body, btCollisionShape& shape);
  [[nodiscard]] btCollisionShape& makeShape(GuestShape kind, double size, std::uint64_t seed);
  /// Forgets what the broadphase found for a body, as hosts do after they changed its filter.
  void renewPairs(GuestBody& body);

  void addJoint(Draw& draw);
  void removeJoint(std::size_t index);
  /// Takes a body out first, and its joints then.
  void removeBeforeJoints(GuestBody& body);

  /// Sets up or removes a spring of the host's: a force by a body's place before each step.
  void toggleSpring(Draw& draw);

  /// Ties a link to a body, to another link or to the world.
  void addTie(Draw& draw);
  void toggleArm(GuestArm& arm);

  void toggleFloor();
  void moveFloor(btScalar up);
  void putBack();
  void toggleThrong();
  void toggleGhost();
  void toggleAction(Draw& draw);
  void replaceSolver();
  void save();
  void restore();
  void reset();
  /// Motion of a body.
  struct Saved {
    btTransform pose;
    btVector3 v, w;
  };
  [[nodiscard]] Saved motionOf(std::size_t body) const;
  /// Puts a body elsewhere, as hosts do that restore a state.
  void put(std::size_t body, const Saved& motion) { place(*bodies_[body], motion); }

  /// Ends the world, with its bodies in it or not; they live on.
  void endWorld();
  /// Puts all bodies into a new world, in order and without joints.
  void beginNewWorld();

 private:
  struct Physics {
    explicit Physics(const GuestCase& one);
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btGhostPairCallback ghost_pairs;
    std::unique_ptr<btBroadphaseInterface> broadphase;
    std::unique_ptr<btConstraintSolver> solver;
    std::unique_ptr<btDiscreteDynamicsWorld> world;
    const GuestWatch* watch = nullptr;  ///< the world
  };

  void makeFloor();
  void removeJointsOf(const GuestBody& body);
  [[nodiscard]] btCollisionShape& makeOwnShape(GuestShape kind, double size, std::uint64_t seed);
  [[nodiscard]] btCollisionShape& makeCompound(Draw& draw, double size);
  void place(GuestBody& body, const Saved& state);
  void makeArms();
  void addArm(GuestArm& arm);
  [[nodiscard]] std::unique_ptr<btConstraintSolver> makeSolver() const;
  [[nodiscard]] btCollisionShape& keep(std::unique_ptr<btCollisionShape> shape);
  static void inPreTick(btDynamicsWorld* world, btScalar dt);

  const GuestCase& case_;
  std::vector<btScalar> heights_;
  btTriangleMesh triangles_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::unique_ptr<Physics> physics_;
  std::unique_ptr<btRigidBody> floor_;
  bool has_floor_ = true;
  std::vector<std::unique_ptr<GuestBody>> bodies_;
  std::vector<std::unique_ptr<btRigidBody>> throng_;
  std::unique_ptr<btGhostObject> ghost_;
  std::unique_ptr<btActionInterface> action_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<std::unique_ptr<GuestArm>> arms_;
  struct Spring {
    const GuestBody* body;
    btVector3 at;
    btScalar stiffness;  ///< [N/m]
  };
  void pullBySprings();

  std::vector<Spring> springs_;
  std::vector<std::unique_ptr<btConstraintSolver>> old_solvers_;
  std::vector<Saved> saved_;
  const std::function<void()>* pending_ = nullptr;
  int steps_ = 0;
  int gravity_step_ = -10;  ///< in which the gravity of the world was set
};

}  // namespace tandem::demos::bench
