// A recorded run of more than two sites is shown as any of its users saw it.

#include <algorithm>

#include <gtest/gtest.h>

#include "replay/run_replay.h"
#include "run/run_output.h"
#include "support/temp_folder.h"
#include "view/run_rig.h"

namespace tandem::view {
namespace {

TEST(ReplayOfMany, ShowsAllUsersAndAllCopies) {
  const tandem::test::TempFolder folder;
  const demos::Scenario scenario = tandem::test::loadWorld(
      "rail", {"site=[{hand_force=[5, 0, 0]}, {}, {}, {}]", "experiment.duration=1"});
  demos::VirtualRun run(scenario);
  run.run();
  {
    const demos::OutputFolder output(folder.path(), "--out");
    demos::writeRun(output, demos::makeSummary(scenario, run), run);
  }
  const RecordedRun recorded = loadRecordedRun(folder.path());
  ASSERT_EQ(recorded.sites.size(), 4u);
  for (int user = 0; user < 4; ++user) {
    RunReplay replay(recorded, user);
    const SessionLook look = replay.look(1.0);
    const auto count = [&](const std::string& name, bool is_ghost) {
      return std::ranges::count_if(look.list.solids, [&](const Solid& solid) {
        return solid.name == name && solid.is_ghost == is_ghost;
      });
    };
    for (const char* proxy : {"proxy", "proxy2", "proxy3"}) EXPECT_EQ(count(proxy, false), 1);
    EXPECT_EQ(count("cube", false), 1);
    // User 1's copy is ahead of the others, so the others see it, and it sees all of them.
    EXPECT_EQ(count("cube", true), user == 0 ? 3 : 1) << user;
  }
  EXPECT_NE(test::refusalOf([&] { RunReplay(recorded, 4); }).find("has sites 1 to 4"),
            std::string::npos);
}

}  // namespace
}  // namespace tandem::view
