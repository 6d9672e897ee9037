// Refused calls on bodies.

#include "c_door/refusal_rig.h"

namespace tandem {
namespace {

using namespace test;

TandemBodySettings spoilBody(const std::function<void(TandemBodySettings&)>& spoil) {
  TandemBodySettings settings = tandem_default_body_settings();
  spoil(settings);
  return settings;
}
TandemResult add(Scene& scene, const TandemBodySettings& settings) {
  TandemBody body = 77;
  const TandemResult result = tandem_world_add_body(scene.bare, &settings, &body);
  EXPECT_EQ(body, 77u);
  return result;
}
Case addCase(const char* name, const char* words,
             const std::function<void(TandemBodySettings&)>& spoil) {
  return {name, TANDEM_INVALID_ARGUMENT, words,
          [spoil](Scene& scene) { return add(scene, spoilBody(spoil)); }};
}
/// A compound of a cube and a part that `spoil` makes of another.
Case compoundCase(const char* name, const char* words,
                  const std::function<void(TandemShapePart&)>& spoil) {
  return {name, TANDEM_INVALID_ARGUMENT, words, [spoil](Scene& scene) {
            TandemShapePart parts[2]{};
            for (TandemShapePart& part : parts) {
              part.size[0] = part.size[1] = part.size[2] = 0.02;
              part.orientation[3] = 1.0;
            }
            spoil(parts[1]);
            const TandemBodySettings settings = tandem_default_body_settings();
            TandemBody body = 77;
            const TandemResult result =
                tandem_world_add_compound(scene.bare, &settings, 2, parts, &body);
            EXPECT_EQ(body, 77u);
            return result;
          }};
}

std::vector<Case> bodyCases() {
  return {
      addCase("Cookie", "not from tandem_default_body_settings()",
              [](auto& s) { s = TandemBodySettings{}; }),
      addCase("Kind", "shape = 17: must be one of TandemShapeKind",
              [](auto& s) { setNumber(s.shape, 17); }),
      addCase("Size", "half_extents.y", [](auto& s) { s.size[1] = 0.0; }),
      addCase("SizeNan", "half_extents.y", [](auto& s) { s.size[1] = kNan; }),
      addCase("Mass", "mass = -1: must be finite, 0 or more", [](auto& s) { s.mass = -1.0; }),
      addCase("MassTiny", "large enough for Bullet's scalars", [](auto& s) { s.mass = 1e-320; }),
      addCase("Inertia", "inertia = 1 0 1", [](auto& s) { s.inertia[0] = s.inertia[2] = 1.0; }),
      addCase("Friction", "friction = -0.5", [](auto& s) { s.friction = -0.5; }),
      addCase("Restitution", "restitution = 2: must be 0 to 1",
              [](auto& s) { s.restitution = 2.0; }),
      addCase("Start", "start.position = (0, nan, 0): must be finite",
              [](auto& s) { s.start.position[1] = kNan; }),
      addCase("Orientation", "start.orientation = (0, 0, 0, 2): must be x, y, z, w of length 1",
              [](auto& s) { s.start.orientation[3] = 2.0; }),
      addCase("StaticVelocity", "static body",
              [](auto& s) { s.mass = 0.0, s.start.velocity[0] = 1.0; }),
      addCase("PlaneMass", "mass of a plane = 0.2: must be 0",
              [](auto& s) { s.shape = TANDEM_PLANE; }),
      addCase("HullNull", "points is null", [](auto& s) { s.shape = TANDEM_HULL; }),
      addCase("HullFlat", "one plane",
              [](auto& s) {
                static const double flat[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
                s.shape = TANDEM_HULL, s.points = flat, s.point_count = 4;
              }),
      compoundCase("PartKind", "shape = 17", [](auto& part) { setNumber(part.shape, 17); }),
      compoundCase("PartSize", "half_extents.y", [](auto& part) { part.size[1] = -1.0; }),
      compoundCase("PartPlane", "a plane cannot be part",
                   [](auto& part) { part.shape = TANDEM_PLANE; }),
      compoundCase("PartPosition", "parts[1].position = (0, nan, 0): must be finite",
                   [](auto& part) { part.position[1] = kNan; }),
      compoundCase("PartOrientation", "parts[1].orientation = (0, 0, 0, 2): must be",
                   [](auto& part) { part.orientation[3] = 2.0; }),
      {"NoParts", TANDEM_INVALID_ARGUMENT, "a compound needs a shape",
       [](Scene& scene) {
         const TandemBodySettings settings = tandem_default_body_settings();
         TandemBody body = 0;
         return tandem_world_add_compound(scene.bare, &settings, 0, nullptr, &body);
       }},
      {"HostsWorld", TANDEM_INVALID_ARGUMENT, "the world is the host's",
       [](Scene& scene) {
         const TandemBodySettings settings = tandem_default_body_settings();
         TandemBody body = 0;
         return tandem_world_add_body(scene.hosts, &settings, &body);
       }},
      {"NotInTheWorld", TANDEM_INVALID_ARGUMENT, "not in this Bullet world",
       [](Scene& scene) {
         btSphereShape shape(btScalar(1));
         btRigidBody stray(1, nullptr, &shape);
         TandemBody body = 0;
         return tandem_world_find_body(scene.hosts, &stray, &body);
       }},
      {"Unknown", TANDEM_INVALID_ARGUMENT, "body 99 is none of this world",
       [](Scene& scene) {
         TandemState state{};
         const TandemBody body = 99;
         return tandem_world_get_states(scene.world, 1, &body, &state);
       }},
      {"NoBody", TANDEM_INVALID_ARGUMENT, "TANDEM_NO_BODY",
       [](Scene& scene) { return tandem_world_remove_body(scene.world, TANDEM_NO_BODY); }},
      {"RemoveShared", TANDEM_IN_USE, "is shared by a site",
       [](Scene& scene) { return tandem_world_remove_body(scene.world, scene.cube); }},
      {"RemoveProxy", TANDEM_IN_USE, "or its proxy",
       [](Scene& scene) { return tandem_world_remove_body(scene.world, scene.proxy); }},
      {"SetNan", TANDEM_INVALID_ARGUMENT, "state.velocity = (0, 0, inf): must be finite",
       [](Scene& scene) {
         TandemState state = makeState(Vec3::Zero());
         state.velocity[2] = std::numeric_limits<double>::infinity();
         return tandem_world_set_state(scene.world, scene.cube, &state);
       }},
      {"ForceNan", TANDEM_INVALID_ARGUMENT, "torque = (nan, 0, 0): must be finite",
       [](Scene& scene) {
         const double force[3] = {1.0, 0.0, 0.0}, torque[3] = {kNan, 0.0, 0.0};
         return tandem_world_apply_force(scene.world, scene.cube, force, torque);
       }},
      {"ForceOnStatic", TANDEM_INVALID_ARGUMENT, "is static: no force moves it",
       [](Scene& scene) {
         const double force[3] = {1.0, 0.0, 0.0};
         return tandem_world_apply_force(scene.world, scene.wall, force, nullptr);
       }},
      {"TakenOut", TANDEM_CANNOT, "was taken out of the world by the host",
       [](Scene& scene) {
         btRigidBody& rigid = scene.rig.addCube(1.0);
         TandemBody body = 0;
         ok(tandem_world_find_body(scene.hosts, &rigid, &body));
         scene.rig.world.removeRigidBody(&rigid);
         TandemState state{};
         const TandemResult result = tandem_world_get_states(scene.hosts, 1, &body, &state);
         scene.rig.world.addRigidBody(&rigid);
         return result;
       }},
  };
}

INSTANTIATE_TEST_SUITE_P(Bodies, Refused, ::testing::ValuesIn(bodyCases()), nameOf);

}  // namespace
}  // namespace tandem
