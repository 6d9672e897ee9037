// The worlds of demos/worlds: nothing breaks in virtual time and live, and each shows what its
// title says.

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/falcon/mouse_device.h"
#include "tandem/plugin/recording.h"

#include "run/virtual_run.h"
#include "session/live_session.h"
#include "support/checkout.h"
#include "view/own_world.h"

namespace tandem::demos {
namespace {

using test::loadWorld;

/// A world whose two sites have run to the end.
class Ended {
 public:
  explicit Ended(const std::string& name, const std::vector<std::string>& overrides = {})
      : run_(loadWorld(name, overrides)) {
    run_.run();
  }

  [[nodiscard]] VirtualRun& run() { return run_; }
  [[nodiscard]] Site& site(int index) { return run_.world(index).site(); }
  /// Where a body is at user 1's site.
  [[nodiscard]] Vec3 at(const std::string& name) { return find(name, 0); }
  /// The largest distance of two copies of what is shared [m].
  [[nodiscard]] double apart() {
    double apart = 0.0;
    for (const SceneBody& body : run_.world(0).bodies())
      if (body.role == "object")
        apart = std::max(apart, (find(body.name, 0) - find(body.name, 1)).norm());
    return apart;
  }
  /// Largest and smallest value of one coordinate of a body over the run, at user 1's site.
  [[nodiscard]] std::pair<double, double> range(const std::string& name, int axis) {
    const auto& bodies = run_.world(0).bodies();
    const auto body = std::ranges::find(bodies, name, &SceneBody::name);
    const auto index = static_cast<std::size_t>(body - bodies.begin());
    std::pair<double, double> range{HUGE_VAL, -HUGE_VAL};
    for (const SceneFrameRecord& frame : run_.scene().frames()) {
      range.first = std::min(range.first, frame.poses[index].p_W[axis]);
      range.second = std::max(range.second, frame.poses[index].p_W[axis]);
    }
    return range;
  }

 private:
  Vec3 find(const std::string& name, int site) {
    const auto& bodies = run_.world(site).bodies();
    const auto body = std::ranges::find(bodies, name, &SceneBody::name);
    return run_.world(site).pose(*body).p_W;
  }
  VirtualRun run_;
};

/// What a world shows, as a check of its end.
using Story = std::function<void(Ended&)>;

const std::map<std::string, Story> kStories = {
    {"beam", [](Ended& world) { EXPECT_GT(world.range("beam", 2).second, 0.11); }},
    {"bowl",
     [](Ended& world) {
       const auto [low, high] = world.range("ball", 0);
       EXPECT_GT(high - low, 0.018);
       EXPECT_LT(world.at("ball").head<2>().norm(), 0.04);
       EXPECT_GT(world.range("ball", 2).first, 0.019);
     }},
    {"crate", [](Ended& world) { EXPECT_GT(world.at("cube").x(), 0.1); }},
    {"cube", [](Ended& world) { EXPECT_GT(world.at("cube").x(), 0.04); }},
    {"door",
     [](Ended& world) {
       EXPECT_GT(world.range("leaf", 0).second, 0.03);
       EXPECT_LT(world.range("leaf", 0).first, -0.005);
     }},
    {"drawer",
     [](Ended& world) {
       EXPECT_LT(world.range("drawer", 0).first, -0.08);
       EXPECT_GT(world.at("drawer").x(), -0.03);
       const Vec3 ball = world.at("ball") - world.at("drawer");
       EXPECT_LT(ball.cwiseAbs().x(), 0.06);
       EXPECT_LT(ball.cwiseAbs().z(), 0.02);
     }},
    {"heap",
     [](Ended& world) {
       for (int i = 1; i <= 5; ++i) EXPECT_GT(world.at("brick" + std::to_string(i)).x(), 0.09);
       EXPECT_LT(std::abs(world.at("blade").y()), 0.01);
     }},
    {"peg",
     [](Ended& world) {
       const Vec3 peg = world.at("peg") - world.at("block");
       EXPECT_LT(peg.head<2>().norm(), 0.002);
       EXPECT_LT(world.at("peg").z(), 0.031);
     }},
    {"plank",
     [](Ended& world) {
       EXPECT_GT(world.range("plank", 2).second, 0.07);
       EXPECT_NEAR(world.at("plank").y(), 0.16, 0.01);
     }},
    {"rail", [](Ended& world) { EXPECT_GT(world.range("cube", 0).second, 0.05); }},
    {"robot",
     [](Ended& world) {
       EXPECT_GT(world.range("hand_plate", 1).second, 0.06);
       EXPECT_LT(world.at("hand_plate").y(), 0.03);
       EXPECT_GT(world.at("hand_plate").z(), 0.2);
     }},
    {"seesaw",
     [](Ended& world) {
       EXPECT_GT(world.at("cube").z(), 0.05);
       EXPECT_LT(world.range("cube", 2).first, 0.06);
       EXPECT_GT(world.range("cube", 2).second, 0.064);
     }},
    {"touch",
     [](Ended& world) { EXPECT_LE(world.run().summary().sites[1].contact_transitions, 6); }},
    {"tower",
     [](Ended& world) {
       EXPECT_LT(world.at("cube1").head<2>().norm(), 0.002);
       EXPECT_GT(world.at("cube4").x(), 0.02);
       EXPECT_LT(world.at("cube5").z(), 0.11);
     }},
};

TEST(Worlds, HaveAStoryEach) {
  std::size_t count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(tandem::test::inCheckout("demos/worlds"))) {
    if (entry.path().extension() != ".toml") continue;
    const std::string name = entry.path().stem();
    EXPECT_TRUE(kStories.contains(name)) << name;
    const auto page = tandem::test::inCheckout("docs/worlds/" + name + ".md");
    EXPECT_TRUE(std::filesystem::exists(page)) << page;
    ++count;
  }
  EXPECT_EQ(count, kStories.size());
}

class EachWorld : public testing::TestWithParam<std::string> {};

TEST_P(EachWorld, TellsItsStory) {
  Ended world(GetParam());
  kStories.at(GetParam())(world);
  EXPECT_LT(world.apart(), 0.01);
  for (int site : {0, 1}) {
    EXPECT_EQ(world.site(site).status(), kTickOk);
    // The hand got no more than it and the other user put in.
    EXPECT_GE(world.run().summary().sites[site].passivity.lowest(), 0.0);
  }
}

TEST_P(EachWorld, LivesWithAMouse) {
  const Scenario scenario = loadWorld(GetParam());
  MouseSettings settings;
  settings.start_W = computeStart(scenario, makeSceneFrame(scenario), 0);
  MouseDevice mouse(settings);
  const view::LiveSession session(scenario, mouse);
  while (session.look()->time < 1.0) sleepFor(0.01);
  EXPECT_EQ(session.look()->status, kTickOk);
  EXPECT_LT(session.look()->force_W.norm(), 1.0) << "the hand begins inside something";
}

INSTANTIATE_TEST_SUITE_P(Worlds, EachWorld, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const auto& [name, story] : kStories) names.push_back(name);
                           return names;
                         }()),
                         [](const auto& info) { return info.param; });

// At 3 s user 2 has not come yet. One hand stretches the tie of the copies by millimetres.
TEST(Worlds, ACrateMovesOnlyWithTwo) {
  EXPECT_LT(Ended("crate", {"experiment.duration=3"}).at("cube").x(), 0.004);
}

TEST(Worlds, ABeamIsOnlyTiltedByOne) {
  Ended world("beam", {"experiment.duration=5", "site2.hand_waypoints=[[0,0,0,0]]"});
  EXPECT_LT(world.range("beam", 2).second, 0.1);
}

TEST(Worlds, ATouchBuzzesOnlyWithTheKinematicScheme) {
  Ended world("touch", {"experiment.scheme=kinematic_proxy"});
  EXPECT_GE(world.run().summary().sites[1].contact_transitions, 20);
}

}  // namespace
}  // namespace tandem::demos
