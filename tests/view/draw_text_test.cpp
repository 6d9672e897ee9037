#include "scene/draw_text.h"

#include <memory>

#include <gtest/gtest.h>

namespace tandem::test {
namespace {

using view::DrawList;
using view::Line;
using view::Solid;
using view::writeDrawList;

Solid makeSolid() {
  view::ShapeMesh mesh;
  mesh.vertices.resize(3);
  mesh.indices = {0, 1, 2, 0, 2, 1};
  Solid solid;
  solid.mesh = std::make_shared<const view::ShapeMesh>(mesh);
  solid.name = "cube";
  solid.p_WB = {0.1, -0.25, 1.0000004};
  solid.colour = {1.0F, 0.5F, 0.0F};
  return solid;
}

TEST(DrawText, NothingIsNoText) { EXPECT_EQ(writeDrawList({}), ""); }

TEST(DrawText, ASolidIsALine) {
  DrawList list;
  list.solids = {makeSolid(), makeSolid()};
  list.solids[1].name = "hand";
  list.solids[1].is_ghost = true;
  EXPECT_EQ(writeDrawList(list),
            "cube: 2 triangles at 0.100000 -0.250000 1.000000 "
            "turned 1.000000 0.000000 0.000000 0.000000 colour #ff8000\n"
            "hand: 2 triangles at 0.100000 -0.250000 1.000000 "
            "turned 1.000000 0.000000 0.000000 0.000000 colour #ff8000 ghost\n");
}

TEST(DrawText, ALineIsALine) {
  DrawList list;
  list.lines = {Line{{0, 0, 1}, {0, 0, -2}, {0.0F, 0.0F, 1.0F}, 2.0F}};
  EXPECT_EQ(writeDrawList(list),
            "line from 0.000000 0.000000 1.000000 to 0.000000 0.000000 -2.000000 "
            "colour #0000ff width 2.0\n");
}

TEST(DrawText, ZeroHasNoSign) {
  for (const double tiny : {-0.0, -1e-9, -4e-7, -5e-7, 4e-7, -1e-300}) {
    DrawList list;
    list.solids = {makeSolid()};
    list.solids[0].p_WB = Vec3::Constant(tiny);
    list.solids[0].q_WB = Quat(-1.0, tiny, 0.0, -tiny);
    list.lines = {Line{Vec3::Constant(tiny), Vec3::Constant(-tiny), {}, 1.0F}};
    EXPECT_EQ(writeDrawList(list).find("-0.000000"), std::string::npos) << tiny;
  }
}

TEST(DrawText, EqualRotationsGiveEqualText) {
  DrawList one, other;
  one.solids = other.solids = {makeSolid()};
  for (const Quat& q : {Quat(0.5, -0.5, 0.5, 0.5), Quat(1e-9, -0.6, 0.8, 0.0)}) {
    one.solids[0].q_WB = q;
    other.solids[0].q_WB = Quat(-q.coeffs());
    EXPECT_EQ(writeDrawList(one), writeDrawList(other));
  }
}

TEST(DrawText, ANameStaysOnItsLine) {
  DrawList list;
  list.solids = {makeSolid()};
  list.solids[0].name = "two\nlines";
  EXPECT_EQ(writeDrawList(list).rfind("two lines: ", 0), 0U);
}

TEST(DrawText, ASolidWithoutAMeshHasNoTriangles) {
  DrawList list;
  list.solids = {Solid{}};
  EXPECT_EQ(writeDrawList(list).rfind(": 0 triangles at ", 0), 0U);
}

}  // namespace
}  // namespace tandem::test
