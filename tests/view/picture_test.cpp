// Pictures without a display: what is drawn where, and the same bits each time.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "view/picture_rig.h"

namespace tandem::view {
namespace {

namespace fs = std::filesystem;
using test::brightness;
using test::countChanged;
using test::makeBall;
using test::makeBox;
using test::makeFloor;
using test::makeSolid;
using test::PictureRig;

using PictureTest = PictureRig;

constexpr Colour kGrey = {.red = 0.8F, .green = 0.8F, .blue = 0.8F};
constexpr Colour kRed = {.red = 0.9F}, kGreen = {.green = 0.8F}, kBlue = {.blue = 0.9F};

// A floor, bodies of pure hues, a ghost and a line.
DrawList makeScene() {
  DrawList list;
  list.solids = {makeFloor(kGrey),
                 makeSolid(makeBox(Vec3(0.02, 0.02, 0.02)), Vec3(-0.08, 0, 0.02), kRed),
                 makeSolid(makeBall(0.02), Vec3(0, 0, 0.02), kGreen),
                 makeSolid(makeBox(Vec3(0.01, 0.03, 0.02)), Vec3(0.08, 0, 0.02), kBlue),
                 makeSolid(makeBall(0.03), Vec3(0.02, 0.02, 0.05), kRed)};
  list.solids.back().is_ghost = true;
  list.lines = {{.from_W = Vec3(0, 0, 0.05), .to_W = Vec3(0, 0, 0.1), .colour = kRed, .width = 3}};
  return list;
}

TEST_F(PictureTest, IsTheSameTwice) {
  const Picture first = draw(makeScene());
  EXPECT_EQ(first.rgba, draw(makeScene()).rgba);
  GlScene other_scene;
  EXPECT_EQ(first.rgba, draw(makeScene(), other_scene).rgba);
}

std::uint64_t hashOf(const Picture& picture) {
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
  for (const std::uint8_t byte : picture.rgba) hash = (hash ^ byte) * 1099511628211ULL;
  return hash;
}

// Run by the test below in processes of their own: the driver counts its threads once.
TEST_F(PictureTest, PrintsItsHash) {
  std::printf("hash %016llx\n", static_cast<unsigned long long>(hashOf(draw(makeScene()))));
}

std::string hashWithThreads(int threads) {
  const std::string command = "LP_NUM_THREADS=" + std::to_string(threads) + " '" +
                              fs::read_symlink("/proc/self/exe").string() +
                              "' --gtest_filter=PictureTest.PrintsItsHash";
  FILE* const output = popen(command.c_str(), "r");
  if (output == nullptr) return {};
  std::string hash;
  for (std::array<char, 256> line = {}; std::fgets(line.data(), line.size(), output) != nullptr;)
    if (std::string(line.data()).starts_with("hash ")) hash = line.data();
  return pclose(output) == 0 ? hash : std::string();
}

TEST_F(PictureTest, IsTheSameForAnyNumberOfThreads) {
  const std::string without_threads = hashWithThreads(0);
  EXPECT_FALSE(without_threads.empty());
  EXPECT_EQ(hashWithThreads(1), without_threads);
  EXPECT_EQ(hashWithThreads(2), without_threads);
}

TEST_F(PictureTest, ShowsEachBodyInItsHueWhereItIs) {
  const DrawList list = makeScene();
  const Picture picture = draw(list);
  for (std::size_t body = 1; body <= 3; ++body) {
    const std::array<int, 3> seen = pixelAt(picture, list.solids[body].p_WB);
    EXPECT_GT(seen[body - 1], seen[body % 3] + 60) << "of body " << body;
    EXPECT_GT(seen[body - 1], seen[(body + 1) % 3] + 60) << "of body " << body;
  }
}

// The ghost's middle is before the blue box's; its upper edge is visible against the floor.
TEST_F(PictureTest, GhostHidesNothing) {
  const auto mesh = makeBox(Vec3(0.02, 0.02, 0.02));
  DrawList list;
  list.solids = {makeFloor(kGrey), makeSolid(mesh, Vec3(0, 0, 0.02), kBlue)};
  const Picture without = draw(list);
  list.solids.push_back(makeSolid(mesh, Vec3(0.005, -0.03, 0.02), kRed));
  list.solids.back().is_ghost = true;
  const Picture with = draw(list);
  EXPECT_EQ(pixelAt(with, Vec3(0, -0.02, 0.03)), pixelAt(without, Vec3(0, -0.02, 0.03)));
  EXPECT_GT(countChanged(with, without), 200);
  EXPECT_LT(countChanged(with, without), 3000);
  const std::array<int, 3> edge = pixelAt(with, Vec3(0.005, -0.05, 0.04));
  EXPECT_GT(edge[0], edge[1] + 60);
}

// A ball as a ghost has an outline and nothing inside.
TEST_F(PictureTest, RoundGhostIsACircle) {
  DrawList list;
  list.solids = {makeSolid(makeBall(0.05), Vec3::Zero(), kRed)};
  list.solids.back().is_ghost = true;
  const Picture with = draw(list), without = draw({});
  const auto middle = projectPoint(eye, size, Vec3::Zero());
  ASSERT_TRUE(middle);
  const double radius = 0.05 * size.height / (2.0 * eye.distance * std::tan(eye.field_of_view / 2));
  int on_circle = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      if (with.at(x, y) == without.at(x, y)) continue;
      const double r = std::hypot(x + 0.5 - middle->point.x, y + 0.5 - middle->point.y);
      EXPECT_NEAR(r, radius, 0.08 * radius) << "at " << x << ", " << y;
      ++on_circle;
    }
  EXPECT_GT(on_circle, 6.0 * radius);
}

TEST_F(PictureTest, ShadowDarkensTheFloorAndLiesAtTheBody) {
  DrawList list;
  list.solids = {makeFloor(kGrey)};
  const Picture empty_floor = draw(list);
  list.solids.push_back(makeSolid(makeBox(Vec3(0.02, 0.02, 0.02)), Vec3(0, 0, 0.02), kRed));
  const Picture with_body = draw(list);
  GlScene fast(Quality::kFast);
  const Picture without_shadow = draw(list, fast);
  // The sun is to the left behind the eye: the shadow lies to the right, right from the wall on.
  for (const double gap : {0.001, 0.006}) {
    const Vec3 shaded(0.02 + gap, 0.01, 0.0);
    EXPECT_LT(brightness(pixelAt(with_body, shaded)),
              0.85 * brightness(pixelAt(empty_floor, shaded)));
    EXPECT_EQ(pixelAt(without_shadow, shaded), pixelAt(empty_floor, shaded));
  }
  const Vec3 sunny(-0.05, -0.03, 0.0);
  EXPECT_EQ(pixelAt(with_body, sunny), pixelAt(empty_floor, sunny));
}

// A lit face that shadowed itself would have stripes.
TEST_F(PictureTest, LitFacesHaveNoStripes) {
  eye.elevation = 1.2;
  for (const double tilt : {0.0, 0.3, 0.6}) {
    DrawList list;
    list.solids = {makeSolid(makeBox(Vec3(0.06, 0.06, 0.01)), Vec3::Zero(), kGrey)};
    list.solids[0].q_WB = Quat(Eigen::AngleAxisd(tilt, Vec3::UnitX()));
    const Picture picture = draw(list);
    const auto at = [&](int i, int k) {
      return brightness(pixelAt(picture, list.solids[0].q_WB * Vec3(0.01 * i, 0.01 * k, 0.01)));
    };
    for (int i = -5; i <= 5; ++i)
      for (int k = -5; k <= 5; ++k) EXPECT_NEAR(at(i, k), at(0, 0), 12) << tilt;
  }
}

TEST_F(PictureTest, EmptyListGivesTheLightBackground) {
  const Picture picture = draw({});
  for (int y = 0; y < size.height; y += 10)
    for (int x = 0; x < size.width; x += 10) {
      EXPECT_GT(brightness(picture.at(x, y)), 190);
      EXPECT_EQ(picture.at(x, y), picture.at(0, y));
    }
}

TEST_F(PictureTest, LeavesOutWhatHasNoPoseOrMesh) {
  const double nan = std::nan("");
  DrawList list;
  list.solids = {makeSolid(nullptr, Vec3::Zero(), kRed),
                 makeSolid(std::make_shared<ShapeMesh>(), Vec3::Zero(), kRed),
                 makeSolid(makeBall(0.02), Vec3(nan, 0, 0), kRed)};
  list.lines = {{.from_W = Vec3(nan, 0, 0), .to_W = Vec3::Zero(), .colour = kRed, .width = 2}};
  EXPECT_EQ(draw(list).rgba, draw({}).rgba);
}

TEST_F(PictureTest, LineIsAsWideAsItSays) {
  eye.elevation = 0.0;
  for (const float width : {1.0F, 3.0F, 6.0F}) {
    DrawList list;
    list.lines = {
        {.from_W = Vec3(0, 0, -0.1), .to_W = Vec3(0, 0, 0.1), .colour = {}, .width = width}};
    const Picture with = draw(list), without = draw({});
    // Darkness adds up to the width, however the edges are blended.
    double darkness = 0.0;
    for (int x = 0; x < size.width; ++x)
      darkness += 1.0 - 1.0 * brightness(with.at(x, size.height / 2)) /
                            brightness(without.at(x, size.height / 2));
    EXPECT_NEAR(darkness, width, 0.1);
  }
}

TEST_F(PictureTest, FollowsANewSize) {
  const Picture large = draw(makeScene());
  size = {.width = 320, .height = 333};
  const Picture small = draw(makeScene());
  EXPECT_EQ(small.rgba.size(), 4U * 320U * 333U);
  const std::array<int, 3> ball = pixelAt(small, Vec3(0, 0, 0.02));
  EXPECT_GT(ball[1], ball[0] + 60);
  size = {.width = 640, .height = 400};
  EXPECT_EQ(draw(makeScene()).rgba, large.rgba);
}

// The mesh keeps its address: only its owner says that it is another one.
TEST_F(PictureTest, NewMeshAtAFreedOnesAddressIsNew) {
  ShapeMesh place = *makeBox(Vec3(0.02, 0.02, 0.02));
  const auto borrow = [&place] {
    return std::shared_ptr<const ShapeMesh>(&place, [](const ShapeMesh*) {});
  };
  DrawList list;
  list.solids = {makeSolid(borrow(), Vec3::Zero(), kRed)};
  const Picture box = draw(list);
  list.solids.clear();
  place = *makeBall(0.05);
  list.solids = {makeSolid(borrow(), Vec3::Zero(), kRed)};
  const Picture ball = draw(list);
  EXPECT_NE(box.rgba, ball.rgba);
  list.solids = {makeSolid(makeBall(0.05), Vec3::Zero(), kRed)};
  EXPECT_EQ(draw(list).rgba, ball.rgba);
}

TEST_F(PictureTest, DropsMeshesThatAreGoneOrUnused) {
  const auto kept = makeBall(0.02);
  size = {.width = 8, .height = 8};
  DrawList list;
  list.solids = {makeSolid(kept, Vec3::Zero(), kRed),
                 makeSolid(makeBall(0.03), Vec3::Zero(), kRed)};
  (void)draw(list);
  EXPECT_EQ(scene.storedMeshes(), 2U);
  (void)draw({});
  EXPECT_EQ(scene.storedMeshes(), 2U);
  list = {};
  (void)draw({});
  EXPECT_EQ(scene.storedMeshes(), 1U);
  for (int frame = 0; frame < 301; ++frame) (void)draw({});
  EXPECT_EQ(scene.storedMeshes(), 0U);
}

TEST_F(PictureTest, StillHasSmootherEdges) {
  GlScene still(Quality::kStill);
  const FrameTarget target(size, 4);
  target.bind();
  still.draw(makeScene(), eye, size);
  target.bindForReading();
  const Picture smooth = readPicture(size), plain = draw(makeScene());
  EXPECT_GT(countChanged(smooth, plain), 500);
  EXPECT_LT(countChanged(smooth, plain), size.width * size.height / 5);
}

}  // namespace
}  // namespace tandem::view
