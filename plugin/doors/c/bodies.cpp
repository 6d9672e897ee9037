#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_bridge/src/world/world_access.h"
#include "c/values.h"
#include "c/world.h"
#include "coordination/src/geometry/compound_parts.h"
#include "coordination/src/geometry/convex_polyhedron.h"

namespace tandem::c_door {
namespace {

/// Marks settings made by tandem_default_body_settings().
constexpr int kCookie = 0x54624f44;

[[nodiscard]] const TandemBodySettings& checkSettings(const TandemBodySettings* settings) {
  if (checkPointer(settings, "settings").internal != kCookie)
    throw std::invalid_argument(
        "the body settings are not from tandem_default_body_settings(); begin with those");
  return *settings;
}

/// A shape of TandemBodySettings or TandemShapePart.
template <typename Settings>
[[nodiscard]] Shape makeHull(const Settings& settings) {
  const double* points = &checkPointer(settings.points, "points");
  std::vector<Vec3> corners;
  corners.reserve(settings.point_count);
  for (std::size_t i = 0; i < settings.point_count; ++i)
    corners.emplace_back(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
  return ConvexHull{std::make_shared<const ConvexPolyhedron>(ConvexPolyhedron::makeHull(corners)),
                    0.0};
}

template <typename Settings>
[[nodiscard]] Shape makeShape(const Settings& settings) {
  const double* size = settings.size;
  const int kind = readNumber(settings.shape);
  switch (kind) {
    case TANDEM_BOX:
      return Box{Vec3(size[0], size[1], size[2])};
    case TANDEM_SPHERE:
      return Sphere{size[0]};
    case TANDEM_CAPSULE:
      return Capsule{size[0], 0.5 * size[1], Axis::kZ};
    case TANDEM_CYLINDER:
      return Cylinder{size[0], 0.5 * size[1], Axis::kZ};
    case TANDEM_HULL:
      return makeHull(settings);
    case TANDEM_CONE:
      return Cone{size[0], 0.5 * size[1], Axis::kZ};
    case TANDEM_PLANE:
      return Plane{Vec3::UnitZ(), 0.0};
    default:
      refuseValue("shape", kind, "one of TandemShapeKind");
  }
}

[[nodiscard]] Shape makeShapes(std::size_t count, const TandemShapePart* parts) {
  if (count > 0) checkPointer(parts, "parts");
  std::vector<ShapePart> shapes;
  shapes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    TandemState pose{};
    std::copy_n(parts[i].position, 3, pose.position);
    std::copy_n(parts[i].orientation, 4, pose.orientation);
    const RigidState read = fromC({"parts", static_cast<std::ptrdiff_t>(i)}, pose);
    shapes.push_back({makeShape(parts[i]), read.p_W, read.q_WB});
  }
  return makeCompound(shapes);
}

[[nodiscard]] OwnBodySettings readSettings(const TandemBodySettings& settings, const Shape& shape) {
  OwnBodySettings body;
  body.shape = shape;
  body.mass = settings.mass;
  body.inertia = readVec3("inertia", settings.inertia);
  body.friction = settings.friction;
  body.restitution = settings.restitution;
  body.start = fromC("start", settings.start);
  return body;
}

/// Adds a body to the world and returns its number.
[[nodiscard]] TandemBody addBody(World& in, OwnWorld& own, const OwnBodySettings& settings) {
  btRigidBody& rigid = own.add(settings);
  try {
    return in.number(rigid);
  } catch (...) {
    own.remove(rigid);
    throw;
  }
}

}  // namespace
}  // namespace tandem::c_door

using namespace tandem;          // NOLINT: the functions of the header are in no namespace
using namespace tandem::c_door;  // NOLINT

extern "C" {

TandemBodySettings tandem_default_body_settings(void) {
  TandemBodySettings settings{};
  settings.internal = kCookie;
  settings.shape = TANDEM_BOX;
  for (double& half : settings.size) half = 0.02;
  const OwnBodySettings defaults;
  settings.mass = defaults.mass;
  settings.friction = defaults.friction;
  settings.restitution = defaults.restitution;
  settings.start = toC({});
  return settings;
}

TandemResult tandem_world_add_body(TandemWorld* world, const TandemBodySettings* settings,
                                   TandemBody* body) {
  return guarded([&] {
    World& in = open(world);
    OwnWorld& own = in.own("tandem_world_add_body()");
    auto& out = checkPointer(body, "body");
    const TandemBodySettings& wanted = checkSettings(settings);
    out = addBody(in, own, readSettings(wanted, makeShape(wanted)));
  });
}

TandemResult tandem_world_add_compound(TandemWorld* world, const TandemBodySettings* settings,
                                       size_t part_count, const TandemShapePart* parts,
                                       TandemBody* body) {
  return guarded([&] {
    World& in = open(world);
    OwnWorld& own = in.own("tandem_world_add_compound()");
    auto& out = checkPointer(body, "body");
    const TandemBodySettings& wanted = checkSettings(settings);
    out = addBody(in, own, readSettings(wanted, makeShapes(part_count, parts)));
  });
}

TandemResult tandem_world_find_body(TandemWorld* world, void* rigid_body, TandemBody* body) {
  return guarded([&] {
    World& in = open(world);
    auto& out = checkPointer(body, "body");
    checkPointer(static_cast<char*>(rigid_body), "rigid_body");
    int place = -1;
    btRigidBody* rigid = findRigidBody(in.bullet(), rigid_body, place);
    if (!rigid)
      throw std::invalid_argument(
          "the rigid body is not in this Bullet world; call addRigidBody() first, and give the "
          "address of the btRigidBody");
    out = in.number(*rigid);
  });
}

TandemResult tandem_world_remove_body(TandemWorld* world, TandemBody body) {
  return guarded([&] {
    World& in = open(world);
    OwnWorld& own = in.own("tandem_world_remove_body()");
    const WorldBody& removed = in.body(body);
    if (removed.is_shared)
      throw Refusal(
          TANDEM_IN_USE,
          "body " + std::to_string(body) +
              " is shared by a site, or its proxy; unshare it, or destroy the site first");
    if (in.guests.is_open)
      throw Refusal(TANDEM_IN_USE,
                    "a step of guests has begun; take bodies out after tandem_world_end_step()");
    own.remove(*removed.rigid);
    in.forget(body);
  });
}

TandemResult tandem_world_get_states(const TandemWorld* world, size_t count,
                                     const TandemBody* bodies, TandemState* states) {
  return guarded([&] {
    const World& in = open(world);
    if (count == 0) return;
    checkPointer(bodies, "bodies");
    checkPointer(states, "states");
    for (std::size_t i = 0; i < count; ++i) (void)in.body(bodies[i]);
    for (std::size_t i = 0; i < count; ++i)
      states[i] = toC(tandem::readState(*in.body(bodies[i]).rigid));
  });
}

TandemResult tandem_world_set_state(TandemWorld* world, TandemBody body, const TandemState* state) {
  return guarded([&] {
    const World& in = open(world);
    const WorldBody& moved = in.body(body);
    if (moved.guest)
      throw std::invalid_argument(
          "body " + std::to_string(body) +
          " is a guest: move it in the host's engine, and tell by tandem_world_begin_step()");
    putBody(in.bullet(), *moved.rigid, fromC("state", checkPointer(state, "state")));
  });
}

TandemResult tandem_world_set_dynamics(TandemWorld* world, TandemBody body,
                                       const TandemDynamics* dynamics) {
  return guarded([&] {
    const World& in = open(world);
    OwnWorld& own = in.own("tandem_world_set_dynamics()");
    const WorldBody& changed = in.body(body);
    const TandemDynamics& wanted = checkPointer(dynamics, "dynamics");
    OwnBodySettings settings;
    settings.mass = wanted.mass;
    settings.inertia = readVec3("inertia", wanted.inertia);
    settings.friction = wanted.friction;
    settings.restitution = wanted.restitution;
    settings.rolling_friction = wanted.rolling_friction;
    settings.spinning_friction = wanted.spinning_friction;
    own.change(*changed.rigid, settings);
  });
}

TandemResult tandem_world_apply_force(TandemWorld* world, TandemBody body, const double force[3],
                                      const double torque[3]) {
  return guarded([&] {
    const World& in = open(world);
    const WorldBody& pushed = in.body(body);
    if (!isDynamic(*pushed.rigid))
      throw std::invalid_argument("body " + std::to_string(body) +
                                  " is static: no force moves it; use tandem_world_set_state()");
    const Vec3 f_W = readVec3OrZero("force", force), t_W = readVec3OrZero("torque", torque);
    applyForce(*pushed.rigid, f_W, t_W);
  });
}

}  // extern "C"
