// Broken folders of runs: one line with file, line or key, and remedy.

#include <algorithm>

#include <gtest/gtest.h>

#include "replay/run_replay.h"
#include "view/run_rig.h"

namespace tandem::view {
namespace {

class ReplayFiles : public test::RunRig {
 protected:
  /// The message, without the folder before it and the remedy after it.
  [[nodiscard]] std::string refusal() const {
    const std::string all =
        test::refusalOf([&] { const RunReplay replay(loadRecordedRun(folder), std::nullopt); });
    const std::string remedy = "; give a folder that `tandem run --out`";
    EXPECT_NE(all.find(remedy), std::string::npos) << all;
    EXPECT_EQ(all.find('\n'), std::string::npos) << all;
    const std::size_t begin = all.rfind(folder.string(), 0) == 0 ? folder.string().size() + 1 : 0;
    return all.substr(begin, all.find(remedy) - begin);
  }
  void cut(const std::string& name, std::size_t bytes) const {
    const std::string text = read(name);
    write(name, text.substr(0, text.size() - bytes));
  }
};

TEST_F(ReplayFiles, AreAllNeeded) {
  for (const char* name : {"site2.csv", "site1.csv", "scene.csv", "summary.json"}) {
    std::filesystem::remove(folder / name);
    EXPECT_EQ(refusal(), std::string(name) + ": cannot be read");
  }
  std::filesystem::create_directory(folder / "summary.json");
  EXPECT_EQ(refusal(), "summary.json: cannot be read");
}

TEST_F(ReplayFiles, ThatAreShortAreRefused) {
  const auto lines = std::ranges::count(read("scene.csv"), '\n');
  cut("scene.csv", 1);
  EXPECT_EQ(refusal(), "scene.csv:" + std::to_string(lines) + ": the line has no end");
  const std::string scene = read("scene.csv");
  const std::size_t last = scene.rfind('\n') + 1;
  write("scene.csv", scene.substr(0, last));
  EXPECT_EQ(refusal(),
            "scene.csv:" + std::to_string(lines) + ": the file ends before body 15 of a frame");
  write("scene.csv", scene.substr(0, scene.find('\n') + 1));
  EXPECT_EQ(refusal(), "scene.csv:2: the file ends before body 0 of a frame");
  write("scene.csv", "");
  EXPECT_EQ(refusal(), "scene.csv: cannot be read");
}

TEST_F(ReplayFiles, OfAHandMustHaveTicksThatGrow) {
  const std::string hand = read("site2.csv");
  write("site2.csv", hand.substr(0, hand.find('\n') + 1));
  EXPECT_EQ(refusal(), "site2.csv:2: there is no tick");
  write("site2.csv", hand);
  edit("site2.csv", "\n0.005,", "\n0.003,");
  EXPECT_EQ(refusal(), "site2.csv:7: the time does not grow");
}

TEST_F(ReplayFiles, ThatAreForeignAreRefused) {
  write("site1.csv", "a,b\n1,2\n");
  EXPECT_EQ(refusal(), "site1.csv:1: there is no column \"t\"");
  write("site1.csv", std::string("\x89PNG\0\n", 6));
  EXPECT_EQ(refusal(), "site1.csv:1: there is no column \"t\"");
  write("summary.json", "{\n\n  \"scenario\": x}\n");
  EXPECT_EQ(refusal(), "summary.json:3: not JSON");
}

TEST_F(ReplayFiles, HoldFiniteNumbers) {
  const std::string good = read("site1.csv");
  for (const char* bad : {"nan", "inf", "1e999", "", "1 ", "0x10", "one"}) {
    write("site1.csv", good);
    edit("site1.csv", "\n0.002,", std::string("\n") + bad + ",");
    EXPECT_EQ(refusal(), std::string("site1.csv:4: t = ") + bad + ": must be a finite number");
  }
  write("site1.csv", good);
  edit("site1.csv", "\n0.002,", "\n0.002,7,");
  const auto columns = std::ranges::count(good.substr(0, good.find('\n')), ',') + 1;
  EXPECT_EQ(refusal(), "site1.csv:4: " + std::to_string(columns + 1) +
                           " values, but the first line names " + std::to_string(columns) +
                           " columns");
}

TEST_F(ReplayFiles, HaveEachBodyInItsTurn) {
  const std::string good = read("scene.csv");
  edit("scene.csv", "\n0,1,1,", "\n0,1,2,");
  EXPECT_EQ(refusal(), "scene.csv:3: body = 2: it is the turn of body 1");
  write("scene.csv", good);
  edit("scene.csv", "\n0,1,1,", "\n0,2,1,");
  EXPECT_EQ(refusal(), "scene.csv:3: site = 2: body 1 is of site 1");
  write("scene.csv", good);
  edit("scene.csv", "\n0,1,1,", "\n0.01,1,1,");
  EXPECT_EQ(refusal(), "scene.csv:3: a frame has two times");
  write("scene.csv", good + good.substr(good.find('\n') + 1));
  EXPECT_NE(refusal().find(": time does not grow"), std::string::npos);
  write("scene.csv", "t,site,body,x,y,z,qw,qx,qy,qz\n0,1,0,0,0,0,3,0,0,0\n");
  EXPECT_EQ(refusal(), "scene.csv:2: qw, qx, qy, qz: no unit quaternion");
}

TEST_F(ReplayFiles, HaveTheBodiesOfTheScenario) {
  const std::string good = read("summary.json");
  const auto bodies = [](nlohmann::json& all) -> nlohmann::json& { return all["scene"]["bodies"]; };
  change("summary.json", [&](auto& all) { bodies(all)[1]["name"] = "roof"; });
  EXPECT_EQ(refusal(),
            "summary.json: scene.bodies: site 1 has \"roof\" where the scenario has \"floor\"");
  write("summary.json", good);
  change("summary.json", [&](auto& all) { all["scenario"]["world"]["boxes"].erase(0); });
  EXPECT_EQ(refusal(), "summary.json: scene.bodies: site 1 has 8 bodies, the scenario 7");
  write("summary.json", good);
  change("summary.json", [&](auto& all) { bodies(all)[2]["site"] = 3; });
  EXPECT_EQ(refusal(), "summary.json: scene.bodies, body 2: must have a site, 1 or 2, and a name");
  write("summary.json", good);
  change("summary.json", [&](auto& all) { bodies(all) = nlohmann::json::array(); });
  EXPECT_EQ(refusal(), "summary.json: scene.bodies: there are none");
}

TEST_F(ReplayFiles, HaveAGoodScenario) {
  change("summary.json", [](auto& all) { all["scenario"]["object"]["mass"] = 0; });
  EXPECT_EQ(
      test::refusalOf([&] { (void)loadRecordedRun(folder); }),
      (folder / "summary.json").string() + ": object.mass = 0: must be a finite number above 0");
}

}  // namespace
}  // namespace tandem::view
