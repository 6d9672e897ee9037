// Worlds from URDF and MJCF: bodies, masses, poses and joints come through, and bad files are
// refused.

#include <cmath>
#include <numbers>
#include <random>

#include "import/imported_world.h"
#include "scenario/scenario.h"
#include "support/temp_folder.h"
#include "view/refused_file.h"
#include "world/scene_world.h"

namespace tandem::demos {
namespace {

const std::string kPendulum =
    R"(<robot name="p"><link name="base"/><link name="bob">
<inertial><origin xyz="0 0 -0.4"/><mass value="2"/>
<inertia ixx="0.002" iyy="0.003" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 0 -0.4"/><geometry><sphere radius="0.05"/></geometry></collision></link>
<joint name="swing" type="revolute"><parent link="base"/><child link="bob"/>
<origin xyz="0 0 1"/><axis xyz="0 1 0"/><limit lower="-1" upper="2" effort="1" velocity="1"/>
<dynamics friction="0.25"/></joint></robot>)";

std::string mjcf(const std::string& bodies) {
  return "<mujoco><worldbody>" + bodies + "</worldbody></mujoco>";
}

void expectBad(const std::string& name, const std::string& text, const std::string& word) {
  const test::TempFolder files;
  expectRefused(files.write(name, text), word, importMujoco);
}

TEST(ImportUrdf, GivesBodiesAndJoints) {
  const test::TempFolder files;
  const ImportedWorld world = importMujoco(files.write("p.urdf", kPendulum));
  ASSERT_EQ(world.bodies.size(), 1u);
  const BodyScenario& bob = world.bodies[0];
  EXPECT_EQ(bob.name, "bob");
  EXPECT_DOUBLE_EQ(bob.mass, 2.0);
  EXPECT_TRUE(bob.position.isApprox(Vec3(0, 0, 0.6), 1e-12));
  ASSERT_TRUE(bob.inertia);
  EXPECT_TRUE(bob.inertia->isApprox(Vec3(0.002, 0.003, 0.004), 1e-9)) << *bob.inertia;
  EXPECT_EQ(bob.shape.kind, "sphere");
  ASSERT_EQ(world.joints.size(), 1u);
  const JointScenario& swing = world.joints[0];
  EXPECT_EQ(swing.kind, "hinge");
  EXPECT_TRUE(swing.at.isApprox(Vec3(0, 0, 1), 1e-12));
  EXPECT_TRUE(swing.axis.isApprox(Vec3::UnitY(), 1e-12));
  EXPECT_EQ((*swing.limits)[1], 2.0);
  EXPECT_EQ(swing.friction, 0.25);
}

/// Time between the first and the fifth pass of the lowest point, two periods [s].
double measureTwoPeriods(const Scenario& scenario) {
  SceneWorld scene(scenario);
  btRigidBody& bob = *scene.bodies()[0].body;
  bob.setActivationState(DISABLE_DEACTIVATION);
  bob.setAngularVelocity(btVector3(0, 0.02, 0));
  bob.setLinearVelocity(btVector3(btScalar(-0.02 * 0.4), 0, 0));
  constexpr double kStep = 1e-3;  // [s]
  std::vector<double> passes;
  btScalar last = 0;
  for (int i = 1; passes.size() < 5 && i < 10000; ++i) {
    scene.world().stepSimulation(btScalar(kStep), 0);
    const btScalar x = bob.getCenterOfMassPosition().x();
    if (i > 1 && (x > 0) != (last > 0)) passes.push_back(i * kStep);
    last = x;
  }
  return passes.size() == 5 ? passes[4] - passes[0] : 0.0;
}

// T = 2 pi sqrt((J + m l^2) / (m g l)), J about the centre of mass; small swings.
TEST(ImportUrdf, APendulumHasThePeriodOfItsLength) {
  const test::TempFolder files;
  std::string text = kPendulum;
  text.replace(text.find("0.25"), 4, "0");
  files.write("p.urdf", text);
  const auto file = files.write("p.toml",
                                "[experiment]\nkind = \"world\"\nguide = false\n[rates]\nhost = "
                                "1000\n[world]\ngravity = 9.81\nfile = \"p.urdf\"\n");
  const double m = 2.0, l = 0.4, J = 0.003;
  const double period = 2.0 * std::numbers::pi * std::sqrt((J + m * l * l) / (m * 9.81 * l));
  // Passes are known to a step of 1 ms each.
  EXPECT_NEAR(measureTwoPeriods(loadScenario(file, {})), 2.0 * period, 4e-3);
}

// Inertia of two balls at +-d along x: m d^2 each, beside their own 2/5 m r^2.
TEST(ImportMjcf, WeldedBodiesAreOne) {
  const test::TempFolder files;
  const std::string ball = R"(<geom type="sphere" size="0.1" mass="1"/>)";
  const ImportedWorld world = importMujoco(
      files.write("w.xml", mjcf(R"(<body name="a" pos="0.5 0 1"><freejoint/>)" + ball +
                                R"(<body name="b" pos="1 0 0">)" + ball + "</body></body>")));
  ASSERT_EQ(world.bodies.size(), 1u);
  const BodyScenario& both = world.bodies[0];
  EXPECT_EQ(world.names.at("b"), "a");
  EXPECT_DOUBLE_EQ(both.mass, 2.0);
  EXPECT_TRUE(both.position.isApprox(Vec3(1, 0, 1), 1e-12));
  EXPECT_EQ(both.parts.size(), 2u);
  const double own = 2.0 * 0.4 * 0.01;
  EXPECT_TRUE(both.inertia->isApprox(Vec3(own, own + 0.5, own + 0.5), 1e-9)) << *both.inertia;
}

TEST(ImportMjcf, HasAllFormsAndJoints) {
  const test::TempFolder files;
  const auto body = [](const std::string& name, const std::string& joint, const std::string& geom) {
    return "<body name=\"" + name + "\">" + joint + "<geom " + geom + "/></body>";
  };
  const ImportedWorld world = importMujoco(files.write(
      "w.xml",
      mjcf("<geom name=\"ground\" type=\"plane\" size=\"1 2 0.1\"/>" +
           body("a", "<freejoint/>", "type=\"box\" size=\"0.1 0.2 0.3\"") +
           body("b",
                "<joint type=\"hinge\" range=\"-30 60\" limited=\"true\" frictionloss=\"0.3\"/>",
                "type=\"capsule\" size=\"0.1 0.2\"") +
           body("c", "<joint type=\"slide\" axis=\"1 0 0\"/>",
                "type=\"cylinder\" size=\"0.1 0.2\"") +
           body("d", "<joint type=\"ball\"/>", "type=\"ellipsoid\" size=\"0.1 0.2 0.3\""))));
  ASSERT_EQ(world.bodies.size(), 5u);
  EXPECT_EQ(world.bodies[0].name, "ground");
  EXPECT_EQ(world.bodies[0].mass, 0.0);
  EXPECT_TRUE(world.bodies[0].shape.size->isApprox(Vec3(2, 4, 0.1)));
  EXPECT_NEAR(world.bodies[0].position.z(), -0.05, 1e-12);
  EXPECT_TRUE(world.bodies[1].shape.size->isApprox(Vec3(0.2, 0.4, 0.6)));
  EXPECT_DOUBLE_EQ(*world.bodies[2].shape.height, 0.4);
  EXPECT_EQ(world.bodies[3].shape.kind, "cylinder");
  EXPECT_EQ(world.bodies[4].shape.kind, "hull");
  ASSERT_EQ(world.joints.size(), 3u);
  EXPECT_EQ(world.joints[0].kind, "hinge");
  EXPECT_NEAR((*world.joints[0].limits)[1], std::numbers::pi / 3.0, 1e-12);
  EXPECT_EQ(world.joints[0].friction, 0.3);
  EXPECT_EQ(world.joints[1].kind, "slider");
  EXPECT_TRUE(world.joints[1].axis.isApprox(Vec3::UnitX()));
  EXPECT_EQ(world.joints[2].kind, "ball");
}

TEST(ImportMjcf, WhatMovesIsAHullOfItsMeshAndWhatStandsIsTheMesh) {
  const test::TempFolder files;
  files.write("t.obj",
              "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const ImportedWorld world = importMujoco(
      files.write("w.xml",
                  "<mujoco><asset><mesh name=\"t\" file=\"t.obj\"/></asset><worldbody>"
                  "<geom type=\"mesh\" mesh=\"t\"/><body name=\"m\" pos=\"1 0 0\"><freejoint/>"
                  "<geom type=\"mesh\" mesh=\"t\"/></body></worldbody></mujoco>"));
  ASSERT_EQ(world.bodies.size(), 2u);
  EXPECT_EQ(world.bodies[0].shape.kind, "mesh");
  EXPECT_EQ(world.bodies[0].shape.triangles.size(), 4u);
  const BodyScenario& moving = world.bodies[1];
  // The centre of mass of a tetrahedron is the mean of its corners.
  EXPECT_TRUE(moving.position.isApprox(Vec3(1.025, 0.025, 0.025), 1e-5)) << moving.position;
}

TEST(ImportMjcf, NamesAreOnesThatAScenarioTakes) {
  const test::TempFolder files;
  const std::string ball = "<freejoint/><geom size=\"0.1\"/></body>";
  const ImportedWorld world = importMujoco(
      files.write("w.xml", mjcf("<body name=\"hand\">" + ball + "<body name=\"a b\">" + ball)));
  EXPECT_EQ(world.names.at("hand"), "hand.2");
  EXPECT_EQ(world.names.at("a b"), "a_b");
}

TEST(ImportMujoco, BadFilesAreRefusedInALine) {
  expectBad("e.xml", "", "");
  expectBad("t.urdf", kPendulum.substr(0, 200), "not URDF or MJCF");
  expectBad("n.urdf", "<robot name=\"x\"><link/></robot>", "not URDF or MJCF");
  expectBad("m.xml", mjcf("<geom type=\"mesh\" mesh=\"none\"/>"), "none");
  expectBad("f.xml",
            "<mujoco><asset><mesh name=\"m\" file=\"no.stl\"/></asset><worldbody><geom "
            "type=\"mesh\" mesh=\"m\"/></worldbody></mujoco>",
            "no.stl");
  expectBad("s.xml", mjcf("<geom size=\"-1\"/>"), "not URDF or MJCF");
  expectBad("j.xml",
            mjcf("<body name=\"two\"><joint axis=\"1 0 0\"/><joint axis=\"0 1 0\"/><geom "
                 "size=\"0.1\"/></body>"),
            "\"two\" has 2 joints");
}

// Each must end in a world or in a line.
TEST(ImportMujoco, DamagedTextEndsInALine) {
  std::mt19937_64 random(7);
  const test::TempFolder files;
  int refused = 0;
  for (int i = 0; i < 40; ++i) {
    std::string text = kPendulum;
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = static_cast<char>(random() % 256);
    try {
      (void)importMujoco(files.write("d.urdf", text));
    } catch (const UsageError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 10);
}

TEST(ImportWorld, SharesByName) {
  const test::TempFolder files;
  const auto file = files.write("p.urdf", kPendulum);
  const Scenario scenario = loadScenario(file, {"world.share=[\"bob\"]"});
  EXPECT_TRUE(scenario.bodies[0].shared);
  EXPECT_EQ(scenario.gravity, 9.81);
  // Ball of 50 mm, a gap of 20 mm, and the hand's own 10 mm.
  EXPECT_NEAR(scenario.sites[0].hand.start_offset.x(), -0.08, 1e-3);
  EXPECT_NEAR(scenario.sites[1].hand.start_offset.x(), 0.08, 1e-3);
  EXPECT_NEAR(scenario.sites[1].hand.start_offset.z(), 0.6, 1e-3);
  expectRefused(file, "there are: bob",
                [](const auto& path) { return loadScenario(path, {"world.share=[\"base\"]"}); });
  expectRefused(file, "--share NAME; there are: bob",
                [](const auto& path) { return loadScenario(path, {}); });
}

TEST(ImportWorld, NumbersBeyondAllWorldsAreRefused) {
  const test::TempFolder files;
  std::string text = kPendulum;
  text.replace(text.find("0 0 1\""), 6, "0 0 1e9\"");
  expectRefused(files.write("p.urdf", text), "1e6",
                [](const auto& path) { return loadScenario(path, {}); });
}

}  // namespace
}  // namespace tandem::demos
