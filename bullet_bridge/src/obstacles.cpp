#include "tandem/bullet_bridge/obstacles.h"

#include <algorithm>
#include <string>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "tandem/bullet_bridge/convert.h"
#include "tandem/bullet_bridge/haptic_body.h"

#include "contact_solver.h"
#include "obstacle_search.h"
#include "world_lookup.h"

namespace tandem {
namespace {

/// Beyond this distance from the first body the private origin follows it [m].
constexpr double kOriginReach = 0.25;
constexpr std::size_t kNoSlot = static_cast<std::size_t>(-1);

/// Whether the host lets the two touch, by groups, masks and ignored pairs.
bool hostLetsTouch(btDiscreteDynamicsWorld& host, const btRigidBody& body,
                   const btCollisionObject& object) {
  const btBroadphaseProxy* a = body.getBroadphaseHandle();
  const btBroadphaseProxy* b = object.getBroadphaseHandle();
  if (a == nullptr || b == nullptr) return false;
  return host.getPairCache()->needsBroadphaseCollision(const_cast<btBroadphaseProxy*>(a),
                                                       const_cast<btBroadphaseProxy*>(b)) &&
         body.checkCollideWith(&object) && object.checkCollideWith(&body);
}

}  // namespace

struct Obstacles::Impl {
  struct HostBody {
    BodyIndex index;
    btRigidBody* body;
  };
  struct Ball {
    BodyIndex index;
    btScalar radius;
  };

  explicit Impl(btDiscreteDynamicsWorld& world)
      : host(world), solver(world.getSolverInfo().m_restitutionVelocityThreshold) {}

  [[nodiscard]] std::size_t findSlot(BodyIndex index) const noexcept {
    const auto i = static_cast<std::size_t>(index);
    return index >= 0 && i < slots.size() ? slots[i] : kNoSlot;
  }
  void filter(btCollisionObject* obstacle, const std::vector<bool>& meets, bool filtered);
  void dropAll();
  void moveOrigin(const std::vector<RigidState>& states);
  void findForBodies(const std::vector<RigidState>& states, btScalar margin);
  void findForSpheres(const std::vector<RigidState>& states, btScalar margin);
  void dropLost();
  void takeFound();

  btDiscreteDynamicsWorld& host;
  ContactSolver solver;
  std::vector<HostBody> bodies;    // by slot
  std::vector<std::size_t> slots;  // by body index
  std::vector<Ball> balls;
  std::vector<Obstacle> near_spheres;
  // Work space of update().
  std::vector<btCollisionObject*> found;
  std::vector<Region> regions;
};

Obstacles::Obstacles(btDiscreteDynamicsWorld& host) : impl_(std::make_unique<Impl>(host)) {}

Obstacles::~Obstacles() { impl_->dropAll(); }

void Obstacles::addBody(BodyIndex index, btRigidBody& body) {
  if (impl_->findSlot(index) != kNoSlot)
    throw Error("island body " + std::to_string(index) + " has a rigid body already; add it once");
  if (index < 0 || body.isStaticOrKinematicObject())
    throw Error("only a dynamic body with an index of its island can be held by obstacles");
  const btCollisionShape& shape = *body.getCollisionShape();
  if (!shape.isConvex() && !shape.isCompound())
    throw Error(std::string("obstacles cannot hold a body of shape ") + shape.getName() +
                "; use a convex shape or a compound of them");
  impl_->dropAll();
  const std::size_t slot = impl_->solver.addBody(body);
  impl_->bodies.push_back({index, &body});
  const auto i = static_cast<std::size_t>(index);
  if (impl_->slots.size() <= i) impl_->slots.resize(i + 1, kNoSlot);
  impl_->slots[i] = slot;
}

void Obstacles::addSphere(BodyIndex index, double radius) {
  impl_->balls.push_back({index, static_cast<btScalar>(radius)});
}

void Obstacles::update(const std::vector<RigidState>& states, double margin) {
  const auto reach = static_cast<btScalar>(margin);
  impl_->moveOrigin(states);
  impl_->findForBodies(states, reach);
  impl_->dropLost();
  impl_->takeFound();
  impl_->findForSpheres(states, reach);
}

const std::vector<Obstacle>& Obstacles::nearSpheres() const noexcept { return impl_->near_spheres; }

bool Obstacles::isNear(BodyIndex body, const RigidState& state, double reach) const noexcept {
  const std::size_t slot = impl_->findSlot(body);
  return slot != kNoSlot && impl_->solver.isNear(slot, state, reach);
}

void Obstacles::predict(BodyIndex body, const RigidState& before,
                        const RigidState& after) noexcept {
  const std::size_t slot = impl_->findSlot(body);
  if (slot != kNoSlot) impl_->solver.predict(slot, before, after);
}

void Obstacles::solve(double dt) noexcept { impl_->solver.solve(dt); }

bool Obstacles::correct(BodyIndex body, RigidState& after) noexcept {
  const std::size_t slot = impl_->findSlot(body);
  return slot != kNoSlot && impl_->solver.correct(slot, after);
}

/// Native contact of an obstacle with all bodies that meet it, off or on. Either may have left the
/// host's world, and be deleted: then it has no contact there.
void Obstacles::Impl::filter(btCollisionObject* obstacle, const std::vector<bool>& meets,
                             bool filtered) {
  const bool obstacle_present = findInWorld(host, obstacle) >= 0;
  for (std::size_t slot = 0; slot < meets.size(); ++slot) {
    if (!meets[slot]) continue;
    btRigidBody* body = bodies[slot].body;
    const bool body_present = findInWorld(host, body) >= 0;
    if (obstacle_present && body_present) {
      filterNativeContact(host, *body, *obstacle, filtered);
    } else if (body_present) {
      body->setIgnoreCollisionCheck(obstacle, filtered);
    } else if (obstacle_present) {
      obstacle->setIgnoreCollisionCheck(body, filtered);
    }
  }
}

void Obstacles::Impl::dropAll() {
  found.clear();
  dropLost();
}

void Obstacles::Impl::moveOrigin(const std::vector<RigidState>& states) {
  if (bodies.empty()) return;
  const Vec3& p_W = states[static_cast<std::size_t>(bodies.front().index)].p_W;
  if ((p_W - solver.origin()).norm() > kOriginReach) solver.setOrigin(p_W);
}

void Obstacles::Impl::findForBodies(const std::vector<RigidState>& states, btScalar margin) {
  found.clear();
  for (const HostBody& entry : bodies) {
    if (findInWorld(host, entry.body) < 0) continue;
    const RigidState& state = states[static_cast<std::size_t>(entry.index)];
    const Region region =
        computeRegion(*entry.body->getCollisionShape(), toBullet(state.p_W, state.q_WB));
    findStaticObjects(host, growRegion(region, margin), found);
  }
  sortAsAdded(found);
}

void Obstacles::Impl::dropLost() {
  const auto& obstacles = solver.obstacles();
  for (std::size_t i = obstacles.size(); i-- > 0;) {
    btCollisionObject* original = obstacles[i]->original;
    const bool is_found = std::find(found.begin(), found.end(), original) != found.end();
    if (is_found && original->getCollisionShape() == obstacles[i]->host_shape) continue;
    filter(original, obstacles[i]->meets, false);
    solver.removeObstacle(original);
  }
}

void Obstacles::Impl::takeFound() {
  for (btCollisionObject* object : found) {
    const auto& known = solver.obstacles();
    const auto copy = std::find_if(known.begin(), known.end(),
                                   [&](const auto& entry) { return entry->original == object; });
    if (copy != known.end()) {
      (*copy)->place(solver.origin());
      continue;
    }
    std::vector<bool> meets;
    for (const HostBody& entry : bodies) {
      meets.push_back(findInWorld(host, entry.body) >= 0 &&
                      hostLetsTouch(host, *entry.body, *object));
    }
    filter(object, meets, true);
    solver.addObstacle(*object, std::move(meets));
  }
}

void Obstacles::Impl::findForSpheres(const std::vector<RigidState>& states, btScalar margin) {
  found.clear();
  regions.clear();
  for (const Ball& ball : balls) {
    const btVector3 p = toBullet(states[static_cast<std::size_t>(ball.index)].p_W);
    regions.push_back(growRegion({p, p}, ball.radius + margin));
    findStaticObjects(host, regions.back(), found);
  }
  sortAsAdded(found);
  near_spheres.clear();
  for (const btCollisionObject* object : found) {
    appendObstacles(*object->getCollisionShape(), object->getWorldTransform(), regions,
                    near_spheres);
  }
}

}  // namespace tandem
