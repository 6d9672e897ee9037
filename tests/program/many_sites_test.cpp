// Scenarios with more than two sites: tables [[site]], places of users, delays, refusals.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "demos/program/import/file_scenario.h"
#include "demos/program/peer/peer_configuration.h"
#include "demos/program/scenario/scenario.h"
#include "demos/program/scenario/site_delays.h"
#include "demos/program/scenario/user_places.h"
#include "demos/program/terminal/usage_error.h"

namespace tandem::demos {
namespace {

using Words = std::vector<std::string>;

/// `count` tables [[site]] without keys.
std::string makeSites(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += "[[site]]\n";
  return text;
}

Scenario parse(const std::string& text, const Words& overrides = {}) {
  return parseScenario(text, "own.toml", overrides);
}

void expectRefused(const std::string& text, const Words& overrides, const Words& words) {
  try {
    (void)parse(text, overrides);
    ADD_FAILURE() << "not refused: " << text;
  } catch (const UsageError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.find('\n'), std::string::npos);
    for (const std::string& word : words)
      EXPECT_NE(line.find(word), std::string::npos) << '"' << word << "\" in: " << line;
  }
}

TEST(ManySites, TwoTablesAreSitesOneAndTwo) {
  const Scenario numbered =
      parse("[site1]\nhand_force = [5, 0, 0]\n[site2]\nstart_offset = [0.01, 0, 0]\n");
  const Scenario listed =
      parse("[[site]]\nhand_force = [5, 0, 0]\n[[site]]\nstart_offset = [0.01, 0, 0]\n");
  EXPECT_EQ(describeScenario(listed), describeScenario(numbered));
}

// Each site's contact gains are felt by the others, by way of the objects. A hand is a user's own.
TEST(ManySites, AgreeOnTheContactGainsOfEachSite) {
  for (const int count : {2, 3}) {
    const Configuration here = makePeerConfiguration(parse(makeSites(count)));
    const auto differs = [&](const Words& overrides) {
      const auto there = makePeerConfiguration(parse(makeSites(count), overrides));
      return findFirstDifference(here, there);
    };
    const auto difference = differs({"site2.contact_stiffness=400"});
    ASSERT_TRUE(difference) << count;
    EXPECT_EQ(difference->key, "site2.contact_stiffness");
    EXPECT_EQ(difference->there, "400.0");
    EXPECT_TRUE(differs({"site1.contact_damping=3"}));
    EXPECT_FALSE(differs({"site2.hand_force=[1, 0, 0]", "site1.device_mass=0.3"}));
  }
}

TEST(ManySites, AreReadBackAsTheyWereDescribed) {
  const Scenario scenario = parse(
      "[[site]]\nhand_force = [5, 0, 0]\ndelay = 0.02\n[[site]]\ndevice_mass = 0.3\n"
      "contact_damping = 2.0\n[[site]]\nhand = \"sine\"\n",
      {"site3.hand_frequency=4"});
  const nlohmann::json described = describeScenario(scenario);
  EXPECT_EQ(described["site"].size(), 3u);
  EXPECT_EQ(described["site"][2]["hand_frequency"], 4.0);
  const Scenario again = readScenario(described, "summary.json");
  EXPECT_EQ(describeScenario(again), described);
  EXPECT_EQ(again.sites[0].delay, 0.02);
  EXPECT_EQ(again.sites[1].device_mass, 0.3);
  EXPECT_FALSE(again.sites[1].device_damping.has_value());
}

TEST(ManySites, TheirNumberMayBeSet) {
  const Scenario scenario =
      parse("[site1]\nhand_force = [5, 0, 0]\n",
            {"site=[{hand_force=[1, 0, 0]}, {}, {}]", "site3.hand_force=[2, 0, 0]"});
  ASSERT_EQ(scenario.sites.size(), 3u);
  EXPECT_EQ(scenario.sites[0].hand.force.x(), 1.0);
  EXPECT_EQ(scenario.sites[2].hand.force.x(), 2.0);
}

TEST(ManySites, AreRefusedByName) {
  expectRefused(makeSites(1), {}, {"own.toml", "site", "1 table", "2 to 16"});
  expectRefused(makeSites(17), {}, {"own.toml:1", "site", "at most 16"});
  expectRefused("[[site]]\nhnad = 1\n[[site]]\n", {},
                {"own.toml:2", "site.1.hnad", "no such key", "hand_force"});
  expectRefused("[[site]]\ndelay = -1\n[[site]]\n", {}, {"site.1.delay = -1", "0 or more"});
  expectRefused(makeSites(3) + "[site1]\nhand_force = [1, 0, 0]\n", {}, {"site1", "either"});
  expectRefused(makeSites(3), {"site4.hand_force=[1, 0, 0]"},
                {"site4.hand_force", "there are 3 sites"});
  expectRefused("[site3]\nhand_force = [1, 0, 0]\n", {},
                {"own.toml:2", "site3.hand_force", "there are 2 sites"});
  expectRefused(makeSites(3), {"site3.hand=csv"}, {"site3.hand", "site3.hand_file"});
}

TEST(ManySites, ToolsBelongToUsersWhoAreThere) {
  const std::string world =
      "[experiment]\nkind = \"world\"\nguide = false\n[[body]]\nname = \"pen\"\n"
      "size = [0.1, 0.01, 0.01]\nmass = 0.1\nshared = true\ntool_of = 3\n";
  EXPECT_EQ(parse(world + makeSites(3)).bodies[0].tool_of, 3);
  expectRefused(world, {}, {"body.pen.tool_of = 3", "there are 2 sites"});
}

TEST(SiteDelays, AreTheBasePlusWhatBothSitesAdd) {
  const Scenario scenario =
      parse(makeSites(3), {"network.delay=0.05", "site1.delay=0.01", "site3.delay=0.1"});
  EXPECT_DOUBLE_EQ(computeDelay(scenario, 0, 1), 0.06);
  EXPECT_DOUBLE_EQ(computeDelay(scenario, 0, 2), 0.16);
  EXPECT_DOUBLE_EQ(computeDelay(scenario, 2, 1), 0.15);
}

TEST(SiteDelays, MayBeAMatrixOfBothWays) {
  const Scenario scenario =
      parse(makeSites(3), {"network.delays=[[0, 0.01, 0.02], [0.03, 0, 0.04], [0.05, 0.06, 0]]"});
  EXPECT_EQ(computeDelay(scenario, 0, 1), 0.01);
  EXPECT_EQ(computeDelay(scenario, 1, 0), 0.03);
  EXPECT_EQ(computeDelay(scenario, 2, 1), 0.06);
  EXPECT_EQ(describeScenario(readScenario(describeScenario(scenario), "summary.json")),
            describeScenario(scenario));
}

TEST(SiteDelays, AreRefusedByName) {
  expectRefused(makeSites(3), {"network.delays=[[0, 1], [1, 0]]"},
                {"network.delays", "2 rows", "3 sites"});
  expectRefused(makeSites(3), {"network.delays=[[0, 1, 1], [1, 0]]"},
                {"network.delays", "a row for each site"});
  expectRefused(makeSites(3), {"network.delays=[[0, -1, 0], [0, 0, 0], [0, 0, 0]]"},
                {"network.delays", "a row for each site"});
  expectRefused(makeSites(2), {"network.delays=[[0, 0.1], [0.1, 0]]", "site2.delay=0.1"},
                {"site2.delay = 0.1", "network.delays", "leave"});
  expectRefused(makeSites(2), {"site2.delay=3"}, {"from site 1 to site 2", "experiment.duration"});
}

TEST(UserPlaces, OfTwoAreInTheMiddleOfTheFaces) {
  const Scenario scenario = parse("");
  EXPECT_EQ(computeUserPlace(scenario, 0), Vec3(-0.03, 0, 0));
  EXPECT_EQ(computeUserPlace(scenario, 1), Vec3(0.03, 0, 0));
}

TEST(UserPlaces, OfManyAreSideBySideWithoutATouch) {
  for (const int count : {3, 4, 5, 8, 9, 16}) {
    const Scenario scenario = parse(makeSites(count), {"object.size=0.1"});
    for (std::size_t i = 0; i < scenario.sites.size(); ++i) {
      const Vec3 place = computeUserPlace(scenario, i);
      EXPECT_DOUBLE_EQ(place.x(), i % 2 == 0 ? -0.06 : 0.06);
      EXPECT_LE(place.tail<2>().cwiseAbs().maxCoeff(), 0.05);
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_GT((place - computeUserPlace(scenario, k)).norm(), 0.021) << i << ", " << k;
    }
  }
}

TEST(UserPlaces, WithoutAnObjectAreARowInContact) {
  const Scenario scenario = parse(makeSites(5), {"experiment.kind=user_contact"});
  for (std::size_t i = 1; i < 5; ++i) {
    const Vec3 step = computeUserPlace(scenario, i) - computeUserPlace(scenario, i - 1);
    EXPECT_LT((step - Vec3(0.02, 0, 0)).norm(), 1e-15);
  }
}

TEST(UserPlaces, ThatDoNotFitAreRefused) {
  expectRefused(makeSites(16), {},
                {"proxy.radius = 0.01", "object.size = 0.04", "8 users", "0.044"});
  EXPECT_EQ(parse(makeSites(16), {"object.size=0.044"}).sites.size(), 16u);
  EXPECT_EQ(parse(makeSites(16), {"proxy.radius=0.008"}).sites.size(), 16u);
}

TEST(ManySites, UsersComeAndGoWhereThatIsFollowed) {
  const std::string follows = "[coordination]\nfollows_users = true\n";
  const Scenario scenario = parse(follows + "[[site]]\n[[site]]\ncomes = 1\ngoes = 2.5\n");
  EXPECT_TRUE(scenario.site.membership.follows);
  EXPECT_EQ(scenario.sites[1].comes, 1.0);
  EXPECT_EQ(scenario.sites[1].goes, 2.5);
  expectRefused("[[site]]\n[[site]]\ncomes = 1\n", {},
                {"site2.comes", "coordination.follows_users"});
  expectRefused(follows + "[[site]]\n[[site]]\ncomes = 2\ngoes = 1\n", {},
                {"site2.goes = 1", "after site2.comes = 2"});
}

// A world file in place of a scenario says nothing of hands.
TEST(ManySites, HandsBeginApartBesideTheBodyOfAWorldFile) {
  Scenario scenario =
      parse(makeSites(10) +
                "[world]\nfloor = true\n[[body]]\nname = \"arm\"\nmass = 0.5\nshared = true\n" +
                "size = [0.2, 0.04, 0.04]\nposition = [1, 0, 0.02]\n",
            {"experiment.kind=world", "experiment.guide=false", "site4.start_offset=[3, 0, 1]"});
  placeUsers(scenario);
  const Vec3 middle(1.0, 0.0, 0.02);
  const double radius = scenario.site.proxy.radius;
  for (std::size_t i = 0; i < scenario.sites.size(); ++i) {
    const Vec3& place = scenario.sites[i].hand.start_offset;
    EXPECT_GE(place.z(), middle.z()) << i;
    EXPECT_GT(std::abs(place.x() - middle.x()), 0.1 + radius) << i;
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT((place - scenario.sites[j].hand.start_offset).norm(), 2.0 * radius)
          << i << ' ' << j;
  }
  EXPECT_EQ(scenario.sites[3].hand.start_offset, Vec3(3.0, 0.0, 1.0));
  EXPECT_EQ(scenario.sites[0].hand.start_offset.x(), 1.0 - (0.1 + radius + 0.02));
}

}  // namespace
}  // namespace tandem::demos
