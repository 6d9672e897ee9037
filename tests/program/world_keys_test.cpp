// Tables [[body]] and [[joint]] of a scenario: what is read, and what is refused in one line.

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "demos/program/scenario/scenario.h"
#include "demos/program/terminal/usage_error.h"

namespace tandem::demos {
namespace {

const std::string kHead = "[experiment]\nkind = \"world\"\nguide = false\n";
const std::string kBall =
    "[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 0.02\nmass = 0.1\n";

Scenario parse(const std::string& text) { return parseScenario(text, "own.toml", {}); }

/// The text must be refused with a line that begins and goes on as given.
void expectRefused(const std::string& text, const std::string& begin, const std::string& word) {
  SCOPED_TRACE(text);
  try {
    (void)parse(text);
    ADD_FAILURE() << "not refused";
  } catch (const UsageError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.rfind(begin, 0), 0u) << line;
    EXPECT_NE(line.find(word), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

TEST(WorldKeys, DescribeBodiesJointsAndACamera) {
  const Scenario s =
      parse(kHead + kBall +
            "shared = true\nposition = [0.1, 0, 0.2]\ncolour = \"#E69F00\"\n"
            "[[body]]\nname = \"bar\"\nmass = 0.2\n"
            "parts = [{size = [0.1, 0.02, 0.02]},\n"
            "  {shape = \"cone\", radius = 0.01, height = 0.02, rotation = [0, 1.5, 0]}]\n"
            "[[joint]]\nkind = \"slider\"\nbodies = [\"bar\", \"ball\"]\n"
            "axis = [0, 0, 2]\nlimits = [-0.1, 0.2]\n"
            "[camera]\ndistance = 0.5\n");
  ASSERT_EQ(s.bodies.size(), 2u);
  EXPECT_EQ(s.bodies[0].shape.radius, 0.02);
  EXPECT_EQ(s.bodies[0].position, Vec3(0.1, 0, 0.2));
  ASSERT_EQ(s.bodies[1].parts.size(), 2u);
  EXPECT_EQ(s.bodies[1].parts[1].shape.kind, "cone");
  ASSERT_EQ(s.joints.size(), 1u);
  EXPECT_EQ(s.joints[0].axis, Vec3(0, 0, 1));
  EXPECT_EQ((*s.joints[0].limits)[1], 0.2);
  EXPECT_EQ(s.camera.distance, 0.5);
  EXPECT_TRUE(s.hasObject());
}

TEST(WorldKeys, AreShownWithoutWhatIsNotGiven) {
  const nlohmann::json shown = describeScenario(parse(kHead + kBall));
  EXPECT_EQ(shown["body"][0]["radius"], 0.02);
  EXPECT_FALSE(shown["body"][0].contains("size"));
  EXPECT_FALSE(shown["body"][0].contains("friction"));
}

TEST(WorldKeys, AWorldWithoutASharedBodyHasNoObject) {
  EXPECT_FALSE(parse(kHead + kBall).hasObject());
}

TEST(WorldKeys, NameTheLine) {
  expectRefused(kHead + kBall + "colour = \"red\"\n", "own.toml:9: body.ball.colour = 'red'",
                "#E69F00");
  expectRefused(kHead + kBall + "masss = 1\n", "own.toml:9: body.ball.masss = 1", "no such key");
  expectRefused(kHead + "[[body]]\nsize = [1, 1, 0]\n", "own.toml:5: body.1.size", "above 0");
  expectRefused(kHead + "[[joint]]\nlimits = [1, 1]\n", "own.toml:5: joint.1.limits", "below");
  expectRefused(kHead + "[[bodies]]\nmass = 1\n", "own.toml:4: bodies", "allowed: body, ");
  expectRefused(kHead + "[body]\nmass = 1\n", "own.toml:4: body", "[[body]]");
}

TEST(WorldKeys, FormsHaveWhatTheyNeedAndNothingElse) {
  const auto form = [](const std::string& keys) {
    return kHead + "[[body]]\nname = \"b\"\n" + keys;
  };
  expectRefused(form("shape = \"sphere\"\n"), "own.toml: body.b", "needs radius");
  expectRefused(form("shape = \"sphere\"\nradius = 1\nheight = 1\n"), "own.toml: body.b",
                "has no height");
  expectRefused(form("shape = \"hull\"\n"), "own.toml: body.b", "points or file");
  expectRefused(form("shape = \"hull\"\npoints = [[0, 0, 0]]\n"), "own.toml: body.b", "4 points");
  expectRefused(form("shape = \"mesh\"\nfile = \"m.obj\"\nmass = 1\n"), "own.toml: body.b.mass",
                "does not move");
  expectRefused(form("parts = [{size = [1, 1, 1], radius = 1}]\n"), "own.toml: body.b.parts.1",
                "has no radius");
  expectRefused(form("size = [1, 1, 1]\nparts = [{size = [1, 1, 1]}]\n"), "own.toml: body.b",
                "either");
  expectRefused(form("size = [1, 1, 1]\nshared = true\n"), "own.toml: body.b.shared", "mass");
  expectRefused(form("size = [1, 1, 1]\ntool_of = 1\n"), "own.toml: body.b.tool_of", "shared");
  expectRefused(form("size = [1, 1, 1]\ntool_of = 17\n"), "own.toml:7: body.b.tool_of", "1 to 16");
}

TEST(WorldKeys, TrianglesHaveTheirPoints) {
  const auto mesh = [](const std::string& triangles) {
    return kHead + "[[body]]\nname = \"b\"\nshape = \"mesh\"\n" +
           "points = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n" + triangles;
  };
  EXPECT_EQ(parse(mesh("triangles = [[0, 1, 2]]\n")).bodies[0].shape.triangles.size(), 1u);
  expectRefused(mesh(""), "own.toml: body.b", "needs triangles");
  expectRefused(mesh("triangles = [[0, 1, 3]]\n"), "own.toml: body.b.triangles", "no point 3");
  expectRefused(mesh("triangles = [[0, 1, 0.5]]\n"), "own.toml:8: body.b.triangles", "numbers of");
  expectRefused(kHead + kBall + "triangles = [[0, 1, 2]]\n", "own.toml: body.ball.triangles",
                "only a mesh");
}

TEST(WorldKeys, InertiaBelongsToABodyThatMoves) {
  const std::string box = kHead + "[[body]]\nname = \"b\"\nsize = [1, 1, 1]\n";
  EXPECT_TRUE(parse(box + "mass = 1\ninertia = [1, 1, 1]\n").bodies[0].inertia.has_value());
  expectRefused(box + "inertia = [1, 1, 1]\n", "own.toml: body.b.inertia", "mass");
  expectRefused(box + "mass = 1\ninertia = [1, 0, 1]\n", "own.toml:8: body.b.inertia", "above 0");
}

TEST(WorldKeys, BodiesHaveNamesOfTheirOwn) {
  expectRefused(kHead + "[[body]]\nsize = [1, 1, 1]\n", "own.toml: body.name", "1 to 57");
  expectRefused(kHead + kBall + kBall, "own.toml: body.name = \"ball\"", "two bodies");
  expectRefused(kHead + "[[body]]\nname = \"floor\"\nsize = [1, 1, 1]\n", "own.toml: body.name",
                "choose another");
}

TEST(WorldKeys, JointsHoldBodiesThatAreThere) {
  const auto joint = [](const std::string& keys) { return kHead + kBall + "[[joint]]\n" + keys; };
  expectRefused(joint("bodies = [\"bell\"]\n"), "own.toml: joint.1.bodies", "no body \"bell\"");
  expectRefused(joint("bodies = [\"ball\", \"ball\"]\n"), "own.toml: joint.1.bodies", "itself");
  expectRefused(joint("kind = \"ball\"\nbodies = [\"ball\"]\nfriction = 1\n"), "own.toml: joint.1",
                "no limits and no friction");
  expectRefused(joint("bodies = [\"ball\"]\nlimits = [-4, 0]\n"), "own.toml: joint.1.limits",
                "3.14");
  expectRefused(
      kHead + "[[body]]\nname = \"wall\"\nsize = [1, 1, 1]\n[[joint]]\nbodies = [\"wall\"]\n",
      "own.toml: joint.1.bodies", "mass above 0");
}

TEST(WorldKeys, SharesNamesOfAWorldFileOnly) {
  expectRefused(kHead + kBall + "[world]\nshare = [\"ball\"]\n", "own.toml: world.share",
                "shared = true");
  expectRefused("[world]\nfile = \"x.urdf\"\n", "own.toml: world.file", "\"world\"");
  EXPECT_TRUE(parse(kHead + "[world]\nfile = \"x.urdf\"\nshare = [\"a\"]\n").hasObject());
}

TEST(WorldKeys, BelongToAWorld) {
  expectRefused(kBall, "own.toml: [[body]]", "\"world\"");
  expectRefused(kHead, "own.toml: experiment.kind", "needs a body");
  expectRefused("[experiment]\nkind = \"world\"\n" + kBall, "own.toml: experiment.guide", "false");
}

}  // namespace
}  // namespace tandem::demos
