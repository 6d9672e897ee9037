// Sessions of three users in one process, over UDP on the loopback. No wall time is asserted.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/falcon/mouse_device.h"
#include "tandem/plugin/key_file.h"

#include "session/peer_session.h"
#include "support/temp_folder.h"
#include "view/free_addresses.h"

namespace tandem::view {
namespace {

constexpr std::size_t kCount = 3;

class ManyPeerSessions : public ::testing::Test {
 protected:
  ManyPeerSessions() {
    makeKeyFile(folder_ / "key");
    const std::vector<std::string> addresses = tandem::test::findFreeAddresses(kCount);
    const demos::SceneFrame frame = demos::makeSceneFrame(scenario);
    for (int site = 1; site <= static_cast<int>(kCount); ++site) {
      demos::PeerLine line;
      line.site = site;
      line.keys = {folder_ / "key"};
      for (int other = 1; other <= static_cast<int>(kCount); ++other) {
        const std::string& address = addresses[static_cast<std::size_t>(other) - 1];
        if (other == site)
          line.bind = address;
        else
          line.peers.push_back(std::to_string(other) + "=" + address);
      }
      MouseSettings settings;
      settings.start_W = demos::computeStart(scenario, frame, site - 1);
      mice_.push_back(std::make_unique<MouseDevice>(settings));
      sessions.push_back(std::make_unique<PeerSession>(scenario, line, *mice_.back()));
    }
    waitFor([&] { return agreeOn("remote_dynamic_proxy"); }, "all to meet");
  }

  /// All are live with this scheme, after equal numbers of changes.
  [[nodiscard]] bool agreeOn(const std::string& scheme) const {
    return std::ranges::all_of(sessions, [&](const auto& session) {
      const auto look = session->look();
      const demos::ChangedScenario agreed = session->scenario();
      return session->goesOn() && !look->is_waiting && look->link == LinkState::kLive &&
             agreed.scenario.scheme == scheme && agreed.changes == sessions[0]->scenario().changes;
    });
  }
  void propose(std::size_t at, const std::string& scheme) {
    sessions[at]->propose(demos::changeScenario(scenario, {"experiment.scheme=" + scheme}));
  }
  template <typename Condition>
  static void waitFor(const Condition& holds, const char* what) {
    for (int turn = 0; !holds(); ++turn) {
      ASSERT_LT(turn, 3000) << "waited in vain for " << what;
      sleepFor(0.01);
    }
  }

  demos::Scenario scenario =
      demos::parseScenario("title = \"three\"\n[[site]]\n[[site]]\n[[site]]\n", "three.toml",
                           {"experiment.duration=120", "coordination.mode=average"});

 private:
  tandem::test::TempFolder folder_;
  std::vector<std::unique_ptr<MouseDevice>> mice_;

 protected:
  std::vector<std::unique_ptr<PeerSession>> sessions;  // the last: they end before their mice
};

TEST_F(ManyPeerSessions, AllFollowOneUsersScheme) {
  propose(1, "kinematic_proxy");
  waitFor([&] { return agreeOn("kinematic_proxy"); }, "user 2's scheme at all");
  propose(2, "virtual_coupling");
  waitFor([&] { return agreeOn("virtual_coupling"); }, "user 3's scheme at all");
}

TEST_F(ManyPeerSessions, TwoChangeAtOnceAndAllEndWithTheSame) {
  propose(1, "kinematic_proxy");
  propose(2, "virtual_coupling");
  waitFor([&] { return agreeOn("kinematic_proxy") || agreeOn("virtual_coupling"); },
          "one scheme at all");
}

// The others go on without a user who leaves.
TEST_F(ManyPeerSessions, OneLeavesAndTheRestGoesOn) {
  sessions.pop_back();
  const std::uint64_t ticks = sessions[0]->look()->loop.ticks;
  waitFor([&] { return sessions[0]->look()->link != LinkState::kLive; }, "the farewell");
  waitFor([&] { return sessions[0]->look()->loop.ticks > ticks + 500; }, "user 1 to go on");
  for (const auto& session : sessions) EXPECT_TRUE(session->goesOn());
}

}  // namespace
}  // namespace tandem::view
