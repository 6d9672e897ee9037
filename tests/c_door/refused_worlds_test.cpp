// Refused calls on worlds and steps.

#include "c_door/refusal_rig.h"

namespace tandem {
namespace {

using namespace test;

std::vector<Case> worldCases() {
  const auto begin = [](Scene& scene, std::vector<TandemBody> bodies, double dt) {
    std::vector<TandemState> states(bodies.size(), makeState(Vec3::Zero()));
    return tandem_world_begin_step(scene.world, dt, nullptr, bodies.size(), bodies.data(),
                                   states.data(), states.data());
  };
  return {
      {"Null", TANDEM_INVALID_ARGUMENT, "the world is null",
       [](Scene&) { return tandem_world_step(nullptr, 1.0, 0, 0.0); }},
      {"NoPlace", TANDEM_INVALID_ARGUMENT, "world is null; give the address of one",
       [](Scene&) { return tandem_world_create(nullptr); }},
      {"WrongKind", TANDEM_INVALID_ARGUMENT, "the world is none",
       [](Scene& scene) {
         return tandem_world_step(reinterpret_cast<TandemWorld*>(scene.device), 1.0, 0, 0.0);
       }},
      {"Twice", TANDEM_INVALID_ARGUMENT, "has been destroyed already",
       [](Scene&) {
         TandemWorld* world = test::makeWorld();
         ok(tandem_world_destroy(world));
         return tandem_world_destroy(world);
       }},
      {"InUse", TANDEM_IN_USE, "the world is used by a site; destroy that first",
       [](Scene& scene) { return tandem_world_destroy(scene.world); }},
      {"Width", TANDEM_WRONG_BULLET, "Bullet scalar width mismatch",
       [](Scene& scene) {
         TandemWorld* world = untouched<TandemWorld>();
         const TandemResult result = tandem_world_attach(
             &scene.rig.world, 12 - tandem_scalar_bytes(), BT_BULLET_VERSION, &world);
         EXPECT_EQ(world, untouched<TandemWorld>());
         return result;
       }},
      {"Version", TANDEM_WRONG_BULLET, "Bullet version mismatch",
       [](Scene& scene) {
         TandemWorld* world = nullptr;
         return tandem_world_attach(&scene.rig.world, tandem_scalar_bytes(), 9, &world);
       }},
      {"NoHost", TANDEM_INVALID_ARGUMENT, "discrete_dynamics_world is null",
       [](Scene&) {
         TandemWorld* world = nullptr;
         return tandem_world_attach(nullptr, TANDEM_ATTACH_ABI, &world);
       }},
      {"Gravity", TANDEM_INVALID_ARGUMENT, "gravity = (0, 0, nan)",
       [](Scene& scene) {
         const double gravity[3] = {0.0, 0.0, kNan};
         return tandem_world_set_gravity(scene.world, gravity);
       }},
      {"StepNan", TANDEM_INVALID_ARGUMENT, "dt = nan",
       [](Scene& scene) { return tandem_world_step(scene.world, kNan, 0, 0.0); }},
      {"Substeps", TANDEM_INVALID_ARGUMENT, "max_substeps = -1: must be 0 or more",
       [](Scene& scene) { return tandem_world_step(scene.world, 0.1, -1, 0.1); }},
      {"FixedStep", TANDEM_INVALID_ARGUMENT, "fixed_step = 0",
       [](Scene& scene) { return tandem_world_step(scene.world, 0.1, 4, 0.0); }},
      {"StepOfHosts", TANDEM_INVALID_ARGUMENT, "the world is the host's: tandem_world_step()",
       [](Scene& scene) { return tandem_world_step(scene.hosts, 0.1, 0, 0.0); }},
      {"EndWithoutBegin", TANDEM_INVALID_ARGUMENT, "no step of guests has begun",
       [](Scene& scene) {
         return tandem_world_end_step(scene.world, 0, nullptr, nullptr, nullptr);
       }},
      {"BeginZero", TANDEM_INVALID_ARGUMENT, "dt = 0",
       [begin](Scene& scene) { return begin(scene, {scene.cube}, 0.0); }},
      {"BeginStatic", TANDEM_INVALID_ARGUMENT, "is static, so no guest",
       [begin](Scene& scene) {
         return begin(scene, {scene.cube, scene.wall}, 0.01);
       }},
      {"BeginTwiceTheSame", TANDEM_INVALID_ARGUMENT, "is in `bodies` twice",
       [begin](Scene& scene) {
         return begin(scene, {scene.cube, scene.cube}, 0.01);
       }},
      {"BeginNan", TANDEM_INVALID_ARGUMENT, "now[1].position = (nan, 0, 0): must be finite",
       [](Scene& scene) {
         const TandemBody bodies[2] = {scene.cube, scene.proxy};
         TandemState states[2] = {makeState(Vec3::Zero()), makeState(Vec3(kNan, 0.0, 0.0))};
         return tandem_world_begin_step(scene.world, 0.01, nullptr, 2, bodies, states, states);
       }},
      {"BeginOfHosts", TANDEM_INVALID_ARGUMENT, "the world is the host's",
       [](Scene& scene) {
         return tandem_world_begin_step(scene.hosts, 0.01, nullptr, 0, nullptr, nullptr, nullptr);
       }},
  };
}

INSTANTIATE_TEST_SUITE_P(Worlds, Refused, ::testing::ValuesIn(worldCases()), nameOf);

}  // namespace
}  // namespace tandem
