#include "object_choice.h"

#include <algorithm>
#include <cstdio>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/shapes.h"

// Bodies are chosen by index, shape and mass, because Bullet's bodies have no names. A host keeps
// names in its own tables, and only the host understands its user pointers.

namespace tandem::preload {
namespace {

/// Calls `look(body, index)` for each dynamic body until it returns true.
template <typename Look>
void forEachMoving(const btDiscreteDynamicsWorld& world, Look look) {
  int index = 0;
  for (int i = 0; i < world.getNumCollisionObjects(); ++i) {
    btRigidBody* body =
        btRigidBody::upcast(const_cast<btCollisionObject*>(world.getCollisionObjectArray()[i]));
    if (!body || body->isStaticOrKinematicObject() || !(body->getInvMass() > 0)) continue;
    if (look(*body, ++index)) return;
  }
}

ShapeWords describeBody(const btRigidBody& body) {
  const std::optional<Shape> shape = findShareableShape(body);
  return shape ? describeShape(*shape) : ShapeWords{};
}

double massOf(const btRigidBody& body) { return 1.0 / static_cast<double>(body.getInvMass()); }

std::string nameOf(const btRigidBody& body, const ShapeWords& shape) {
  char mass[48];
  std::snprintf(mass, sizeof mass, ", %.5g kg", massOf(body));
  return (shape.kind.empty() ? body.getCollisionShape()->getName() : toText(shape)) + mass;
}

bool fits(const PreloadConfig& config, const btRigidBody& body, const ShapeWords& shape,
          int index) {
  return (!config.index || *config.index == index) &&
         (!config.shape || matches(*config.shape, shape)) &&
         (!config.mass || isNearly(massOf(body), *config.mass));
}

}  // namespace

ObjectChoice chooseObject(const btDiscreteDynamicsWorld& world, const PreloadConfig& config,
                          const std::vector<const void*>& leave_alone) {
  ObjectChoice choice;
  forEachMoving(world, [&](btRigidBody& body, int index) {
    const ShapeWords shape = describeBody(body);
    const bool is_left_alone =
        std::find(leave_alone.begin(), leave_alone.end(), &body) != leave_alone.end();
    if (is_left_alone || !fits(config, body, shape, index)) return false;
    if (choice.body) {
      ++choice.others;
    } else {
      choice = {&body, index, 0, shape, massOf(body), nameOf(body, shape)};
    }
    return false;
  });
  return choice;
}

std::vector<const void*> findMovingBodies(const btDiscreteDynamicsWorld& world) {
  std::vector<const void*> bodies;
  forEachMoving(world, [&](const btRigidBody& body, int) {
    bodies.push_back(&body);
    return false;
  });
  return bodies;
}

std::string listObjects(const btDiscreteDynamicsWorld& world) {
  constexpr int kMost = 8;
  std::string list;
  forEachMoving(world, [&](const btRigidBody& body, int index) {
    list += list.empty() ? "" : "; ";
    list += index > kMost ? "..." : std::to_string(index) + ' ' + nameOf(body, describeBody(body));
    return index > kMost;
  });
  return list.empty() ? "none" : list;
}

}  // namespace tandem::preload
