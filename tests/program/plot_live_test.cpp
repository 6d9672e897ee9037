// What `tandem plot` makes of a folder that two live sites wrote to.

#include <gtest/gtest.h>

#include "demos/program/plot/grouping.h"
#include "demos/program/plot/live_run.h"
#include "demos/program/plot/live_section.h"
#include "demos/program/terminal/usage_error.h"
#include "program/process.h"

namespace tandem::demos::plot {
namespace {

using nlohmann::json;
using test::TempFolder;

json siteJson(int site, double late) {
  json j = json::parse(R"({
    "scenario": {"experiment": {"kind": "cooperative_manipulation", "scheme": "kinematic_proxy"},
                 "network": {"delay": 0.05}},
    "scalar": "float64", "network": {"round_trip": 0.102}})");
  j["site" + std::to_string(site)] = {{"contact_transitions", site},
                                      {"force", {{"max", 5.0}, {"mean", 2.0}}}};
  j["loop"] = {{"ticks", 100}, {"late", late}};
  return j;
}

std::string siteCsv(double x) {
  return "t,object_x,object_y,object_z,force_x,force_y,force_z\n0," + std::to_string(x) +
         ",0,0,1,0,0\n0.001," + std::to_string(3.0 * x) + ",0,0,1,0,0\n";
}

struct LiveFolder : TempFolder {
  LiveFolder() {
    write("site1.json", siteJson(1, 3).dump());
    write("site2.json", siteJson(2, 1).dump());
    write("site1.csv", siteCsv(0.002));
    write("site2.csv", siteCsv(0.001));
  }
};

TEST(PlotLive, JoinsWhatBothSitesKnow) {
  const LiveFolder folder;
  const plot::Run run = loadRun(folder.path());
  ASSERT_TRUE(run.live);
  EXPECT_NEAR(run.live->round_trip, 0.102, 1e-15);
  EXPECT_NEAR(run.live->late_share, 0.02, 1e-15);
  EXPECT_NEAR(run.mean_coherency, 0.002, 1e-15);
  EXPECT_NEAR(run.max_coherency, 0.003, 1e-15);
  EXPECT_EQ(run.site[0].contact_transitions, 1.0);
  EXPECT_EQ(run.site[1].contact_transitions, 2.0);
}

TEST(PlotLive, IsNoRunInVirtualTime) {
  const LiveFolder folder;
  const Grouping grouping = groupRuns({loadRun(folder.path())});
  EXPECT_TRUE(grouping.cooperation.empty());
  Report report("live");
  addLive(report, {loadRun(folder.path())});
  EXPECT_EQ(report.figures().size(), 1u);
  folder.write("summary.json", "{}");
  EXPECT_FALSE(isLiveFolder(folder.path()));
}

TEST(PlotLive, TwoScenariosInOneFolderAreRefused) {
  const LiveFolder folder;
  json other = siteJson(2, 0);
  other["scenario"]["device"]["damping"] = 1.0;  // its own business
  folder.write("site2.json", other.dump());
  EXPECT_NO_THROW((void)loadRun(folder.path()));
  other["scenario"]["object"]["mass"] = 0.3;
  folder.write("site2.json", other.dump());
  try {
    (void)loadRun(folder.path());
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("site2.json: another scenario"), std::string::npos);
  }
}

TEST(PlotLive, HalfARunIsRefusedByName) {
  const LiveFolder folder;
  std::filesystem::remove(folder / "site2.json");
  try {
    (void)loadRun(folder.path());
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("site2.json"), std::string::npos);
  }
  folder.write("site2.json", "[]");
  EXPECT_THROW((void)loadRun(folder.path()), UsageError);
}

}  // namespace
}  // namespace tandem::demos::plot
