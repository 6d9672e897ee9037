// Bullet worlds from the bodies and joints of a scenario, and the files that bodies name.

#include "world/scene_world.h"

#include <gtest/gtest.h>

#include "import/obj_file.h"
#include "import/shape_files.h"
#include "support/temp_folder.h"
#include "terminal/usage_error.h"
#include "view/refused_file.h"

namespace tandem::demos {
namespace {

const std::string kTetrahedron =
    "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

Scenario makeWorld(const std::string& bodies) {
  return parseScenario(
      "[experiment]\nkind = \"world\"\nguide = false\n[world]\ngravity = 9.81\n" + bodies,
      "own.toml", {});
}

/// Steps a world for some seconds [s].
void step(SceneWorld& scene, double duration) {
  for (int i = 0; i < static_cast<int>(duration * 240.0); ++i)
    scene.world().stepSimulation(btScalar(1.0 / 240.0), 0);
}

btScalar height(const SceneWorld& scene, std::size_t body) {
  return scene.bodies()[body].body->getCenterOfMassPosition().z();
}

TEST(SceneWorld, HasAllForms) {
  const test::TempFolder files;
  Scenario s = makeWorld(
      "[[body]]\nname = \"a\"\nsize = [1, 2, 3]\nrotation = [0, 0, 1.5707963]\n"
      "[[body]]\nname = \"b\"\nshape = \"sphere\"\nradius = 0.5\n"
      "[[body]]\nname = \"c\"\nshape = \"capsule\"\nradius = 0.5\nheight = 2\n"
      "[[body]]\nname = \"d\"\nshape = \"cylinder\"\nradius = 0.5\nheight = 2\n"
      "[[body]]\nname = \"e\"\nshape = \"cone\"\nradius = 0.5\nheight = 2\n"
      "[[body]]\nname = \"f\"\nshape = \"hull\"\nfile = \"t.obj\"\n"
      "[[body]]\nname = \"g\"\nshape = \"mesh\"\nfile = \"t.obj\"\n"
      "[[body]]\nname = \"h\"\nparts = [{size = [1, 1, 1], position = [2, 0, 0]}, {size = [1, 1, "
      "1]}]\n");
  s.file = files.write("t.obj", kTetrahedron);
  readShapeFiles(s);
  EXPECT_EQ(s.bodies[5].shape.points.size(), 4u);
  EXPECT_EQ(s.bodies[6].shape.triangles.size(), 4u);
  EXPECT_TRUE(s.bodies[6].shape.file.empty());
  const SceneWorld scene(s);
  const std::vector<btVector3> expected = {{2, 1, 3}, {1, 1, 1},       {1, 1, 3},       {1, 1, 2},
                                           {1, 1, 2}, {0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}, {3, 1, 1}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const btRigidBody& body = *scene.bodies()[i].body;
    btVector3 low, high;
    body.getCollisionShape()->getAabb(body.getWorldTransform(), low, high);
    EXPECT_LT(((high - low) - expected[i]).length(), 0.008) << scene.bodies()[i].plan.body.name;
  }
}

TEST(SceneWorld, TakesInertiaAndTrianglesOfTheScenario) {
  const SceneWorld scene(makeWorld(
      "[[body]]\nname = \"b\"\nsize = [1, 1, 1]\nmass = 2\ninertia = [0.1, 0.2, 0.3]\n"
      "[[body]]\nname = \"m\"\nshape = \"mesh\"\npoints = [[0, 0, 0], [2, 0, 0], [0, 3, 0]]\n"
      "triangles = [[0, 1, 2]]\n"));
  const btVector3 inertia = scene.bodies()[0].body->getLocalInertia();
  EXPECT_LT((inertia - btVector3(btScalar(0.1), btScalar(0.2), btScalar(0.3))).length(), 1e-6);
  btVector3 low, high;
  scene.bodies()[1].body->getAabb(low, high);
  EXPECT_LT(((high - low) - btVector3(2, 3, 0)).length(), 0.008);
}

TEST(SceneWorld, JointsHold) {
  const std::string body = "size = [0.1, 0.1, 0.1]\nmass = 1\nposition = [0.2, 0, 1]\n";
  Scenario s = makeWorld("[[body]]\nname = \"swings\"\n" + body +
                         "[[joint]]\nbodies = [\"swings\"]\nat = [0, 0, 1]\n"
                         "axis = [0, 1, 0]\nlimits = [-0.3, 0.5]\n");
  SceneWorld swing(s);
  step(swing, 3.0);
  // The limit leaves it at an angle of 0.5 rad below the level.
  EXPECT_NEAR(height(swing, 0), 1.0 - 0.2 * std::sin(0.5), 0.01);

  SceneWorld slide(
      makeWorld("[[body]]\nname = \"slides\"\n" + body +
                "[[joint]]\nkind = \"slider\"\nbodies = [\"slides\"]\nlimits = [-0.3, 0]\n"));
  step(slide, 2.0);
  EXPECT_NEAR(height(slide, 0), 0.7, 0.01);

  SceneWorld weld(makeWorld("[[body]]\nname = \"hangs\"\n" + body +
                            "[[joint]]\nkind = \"weld\"\nbodies = [\"hangs\"]\n"));
  step(weld, 1.0);
  EXPECT_NEAR(height(weld, 0), 1.0, 0.01);
}

TEST(SceneWorld, FrictionOfAJointHoldsUpToItsForce) {
  const auto slideWith = [](const std::string& friction) {
    SceneWorld scene(
        makeWorld("[[body]]\nname = \"b\"\nsize = [0.1, 0.1, 0.1]\nmass = 1\nposition = [0, 0, 1]\n"
                  "[[joint]]\nkind = \"slider\"\nbodies = [\"b\"]\nfriction = " +
                  friction + "\n"));
    step(scene, 1.0);
    return height(scene, 0);
  };
  EXPECT_NEAR(slideWith("10.5"), 1.0, 0.01);
  EXPECT_LT(slideWith("5"), 0.0);
}

TEST(SceneWorld, JointsKeepTheirZeroWhereverBodiesBegin) {
  const std::string world =
      "[[body]]\nname = \"b\"\nsize = [0.1, 0.1, 0.1]\nmass = 1\nposition = [0, 0, 1]\n"
      "[[joint]]\nkind = \"slider\"\nbodies = [\"b\"]\nlimits = [-0.3, 0.3]\n";
  RigidState lower;
  lower.p_W = Vec3(0, 0, 0.9);
  SceneWorld scene(makeWorld(world), {{"b", lower}});
  step(scene, 2.0);
  EXPECT_NEAR(height(scene, 0), 0.7, 0.01);
}

void expectRefused(const std::string& text, const std::string& word) {
  const test::TempFolder files;
  expectRefused(files.write("x.obj", text), word, readObj);
}

TEST(ObjFile, GivesTriangles) {
  const test::TempFolder files;
  const ObjFile file = readObj(files.write("x.obj", kTetrahedron + "f 1 2 3 4\n"));
  EXPECT_EQ(file.points.size(), 4u);
  EXPECT_EQ(file.triangles.size(), 6u);
  EXPECT_EQ(file.triangles[0], (std::array<std::size_t, 3>{0, 2, 1}));
}

TEST(ObjFile, IsRefusedWhenItIsNone) {
  expectRefused("", "no face");
  expectRefused("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no face");
  expectRefused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "point");
  expectRefused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\n", "");
  expectRefused("v 0 0 0\nv nan 0 0\nv 0 1e9 0\nf 1 2 3\n", "point");
  EXPECT_THROW((void)readObj("/dev/zero"), UsageError);
  EXPECT_THROW((void)readObj("no/such.obj"), UsageError);
}

TEST(SceneWorld, RefusesAFlatHull) {
  const Scenario s = makeWorld(
      "[[body]]\nname = \"b\"\nshape = \"hull\"\nmass = 1\n"
      "points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]\n");
  EXPECT_THROW(SceneWorld{s}, UsageError);
}

}  // namespace
}  // namespace tandem::demos
