// The worlds of demos/worlds in virtual time: nothing breaks, and each shows what its title says.

#include <filesystem>

#include <gtest/gtest.h>

#include "tandem/plugin/recording.h"

#include "run/virtual_run.h"

namespace tandem::demos {
namespace {

Scenario load(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return loadScenario(std::filesystem::path(TANDEM_WORLDS) / (name + ".toml"), overrides);
}

TEST(Worlds, RunToTheirEndsWithoutAFault) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TANDEM_WORLDS)) {
    VirtualRun run(load(entry.path().stem()));
    run.run();
    for (int site : {0, 1}) EXPECT_EQ(run.world(site).site().status(), kTickOk) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 3);
}

/// Way of the crate along the push [m].
double pushCrate(const std::vector<std::string>& overrides) {
  VirtualRun run(load("crate", overrides));
  run.run();
  return run.world(0).site().object(0).p_W.x();
}

// At 3 s user 2 has not come yet. One hand stretches the tie of the copies by millimetres.
TEST(Worlds, ACrateMovesOnlyWithTwo) {
  EXPECT_LT(pushCrate({"experiment.duration=3"}), 0.004);
  EXPECT_GT(pushCrate({}), 0.1);
}

TEST(Worlds, ATouchBuzzesOnlyWithTheKinematicScheme) {
  const auto countChanges = [](const std::string& scheme) {
    VirtualRun run(load("touch", {"experiment.scheme=" + scheme}));
    run.run();
    return run.summary().sites[1].contact_transitions;
  };
  EXPECT_LE(countChanges("remote_dynamic_proxy"), 6u);
  EXPECT_GE(countChanges("kinematic_proxy"), 20u);
}

}  // namespace
}  // namespace tandem::demos
