// Two users' sessions in one process, over UDP on the loopback. No wall time is asserted.

#include "session/peer_session.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/falcon/mouse_device.h"
#include "tandem/plugin/key_file.h"
#include "tandem/plugin/udp_mesh.h"

#include "replay/run_replay.h"
#include "support/temp_folder.h"
#include "terminal/usage_error.h"
#include "view/free_addresses.h"
#include "view/own_world.h"

namespace tandem::view {
namespace {

class PeerSessionTest : public ::testing::Test {
 protected:
  PeerSessionTest() {
    makeKeyFile(key_);
    for (std::size_t at : {0, 1}) {
      lines_[at].site = static_cast<int>(at) + 1;
      lines_[at].bind = addresses_[at];
      lines_[at].peers = {addresses_[1 - at]};
      lines_[at].keys = {key_};
    }
    // One is bound to all addresses, as on two machines.
    lines_[0].bind = addresses_[0].substr(addresses_[0].rfind(':'));
  }
  ~PeerSessionTest() override {
    for (auto& session : sessions) session.reset();  // before its mouse
  }

  void start(int site) {
    const auto at = static_cast<std::size_t>(site - 1);
    MouseSettings settings;
    settings.start_W = demos::computeStart(scenario, demos::makeSceneFrame(scenario), site - 1);
    mice_[at] = std::make_unique<MouseDevice>(settings);
    sessions[at] = std::make_unique<PeerSession>(scenario, lines_[at], *mice_[at],
                                                 records[at] ? &*records[at] : nullptr);
  }
  void startBoth() {
    start(1);
    start(2);
    waitFor([&] { return areLive(); }, "both to meet");
  }
  /// A site of the command line, which follows nothing.
  demos::PeerRun makeRun(int site, const demos::ChangedScenario& changed) {
    return {changed.scenario, site - 1, demos::makeMeshSettings(line(site), changed),
            demos::makeOtherSites(line(site), 2)};
  }
  [[nodiscard]] const demos::PeerLine& line(int site) const {
    return lines_[static_cast<std::size_t>(site - 1)];
  }
  /// A session feels the other user.
  [[nodiscard]] bool isLive(std::size_t at) const {
    const auto look = sessions[at]->look();
    return sessions[at]->goesOn() && !look->is_waiting && look->link == LinkState::kLive &&
           look->loop.ticks > 50;
  }
  [[nodiscard]] bool areLive() const { return isLive(0) && isLive(1); }
  [[nodiscard]] bool hasNote(const std::string& text) const {
    return std::ranges::any_of(sessions[0]->notes(), [&](const std::string& note) {
      return note.find(text) != std::string::npos;
    });
  }
  /// Both have met with this scheme after this number of changes.
  [[nodiscard]] bool meetWith(const std::string& scheme, std::uint32_t changes) const {
    return areLive() && std::ranges::all_of(sessions, [&](const auto& session) {
             const demos::ChangedScenario agreed = session->scenario();
             return agreed.scenario.scheme == scheme && agreed.changes == changes;
           });
  }
  static void waitFor(const std::function<bool()>& holds, const char* what) {
    for (int turn = 0; !holds(); ++turn) {
      ASSERT_LT(turn, 3000) << "waited in vain for " << what;
      sleepFor(0.01);
    }
  }
  [[nodiscard]] demos::Scenario with(const std::string& override_text) const {
    return demos::changeScenario(scenario, {override_text});
  }

  demos::Scenario scenario = tandem::test::loadWorld(
      "cube", {"experiment.duration=120"});  // a site of the command line stays
  std::array<std::optional<SessionRecords>, 2> records;
  std::array<std::unique_ptr<PeerSession>, 2> sessions;

 private:
  tandem::test::TempFolder folder_;
  std::string key_ = folder_ / "key";
  std::vector<std::string> addresses_ = tandem::test::findFreeAddresses(2);
  std::array<demos::PeerLine, 2> lines_;
  std::array<std::unique_ptr<MouseDevice>, 2> mice_;
};

TEST_F(PeerSessionTest, FollowsTheOtherUsersScheme) {
  startBoth();
  sessions[1]->propose(with("experiment.scheme=kinematic_proxy"));
  waitFor([&] { return meetWith("kinematic_proxy", 1); }, "user 2's scheme at both");
  sessions[0]->propose(with("experiment.scheme=virtual_coupling"));
  waitFor([&] { return meetWith("virtual_coupling", 2); }, "user 1's scheme at both");
}

// Two windows record into one folder. A change of scheme ends the first record of both.
TEST_F(PeerSessionTest, BothLeaveRecordsThatAreShownAgain) {
  const tandem::test::TempFolder folder;
  for (std::size_t at : {0, 1})
    records[at].emplace(folder.path() / "run", static_cast<int>(at) + 1);
  startBoth();
  sessions[1]->propose(with("experiment.scheme=kinematic_proxy"));
  waitFor([&] { return meetWith("kinematic_proxy", 1); }, "user 2's scheme at both");
  for (const auto& session : sessions) session->end();
  for (int user : {0, 1}) {
    const RunReplay first(loadRecordedRun(folder.path() / "run"), user);
    EXPECT_EQ(first.scenario().scheme, "remote_dynamic_proxy");
    const RunReplay second(loadRecordedRun(folder.path() / "run-2"), user);
    EXPECT_EQ(second.scenario().scheme, "kinematic_proxy");
    EXPECT_GE(second.frames().size(), 2u);
  }
  EXPECT_EQ(records[0]->count(), 2);
}

TEST_F(PeerSessionTest, FollowsGains) {
  startBoth();
  sessions[0]->propose(with("contact.stiffness=1234.5"));
  waitFor([&] { return meetWith("remote_dynamic_proxy", 1); }, "the gain at both");
  EXPECT_EQ(sessions[1]->scenario().scenario.site.contact.stiffness, 1234.5);
}

TEST_F(PeerSessionTest, BothChangeAtOnceAndEndWithTheSame) {
  startBoth();
  sessions[0]->propose(with("experiment.scheme=kinematic_proxy"));
  sessions[1]->propose(with("experiment.scheme=virtual_coupling"));
  // On a machine that stalls user 2's choice may come after that of user 1 was followed.
  waitFor([&] { return meetWith("kinematic_proxy", 1) || meetWith("virtual_coupling", 2); },
          "one scheme at both");
}

TEST_F(PeerSessionTest, AUserWhoComesAgainFollowsWhatWasChanged) {
  startBoth();
  sessions[0]->propose(with("experiment.scheme=kinematic_proxy"));
  waitFor([&] { return meetWith("kinematic_proxy", 1); }, "user 1's scheme at both");
  sessions[1].reset();
  start(2);
  waitFor([&] { return meetWith("kinematic_proxy", 1); }, "user 2 to come again");
}

// Site 2 is of a release that knows no changes: it goes on, and is met again.
TEST_F(PeerSessionTest, GoesBackIfTheOtherDoesNotFollow) {
  std::jthread other([&](const std::stop_token& stop) {
    demos::PeerRun run = makeRun(2, {scenario, 0});
    const auto asks = [&] { return stop.stop_requested(); };
    if (run.waitForPeers(30.0, asks, [](const auto&) {}))
      run.run(
          asks, [](const auto&) {}, [](const auto&) {});
  });
  start(1);
  waitFor([&] { return isLive(0); }, "both to meet");
  sessions[0]->propose(with("experiment.scheme=kinematic_proxy"));
  waitFor([&] { return sessions[0]->scenario().changes == 1; }, "the change");
  waitFor([&] { return sessions[0]->scenario().changes == 0 && isLive(0); }, "the old scheme");
  EXPECT_EQ(sessions[0]->scenario().scenario.scheme, "remote_dynamic_proxy");
  EXPECT_TRUE(hasNote("site 2 does not follow"));
}

TEST_F(PeerSessionTest, RefusesHostileValuesOfTheOther) {
  UdpMeshSettings settings = demos::makeMeshSettings(line(2), {scenario, 7});
  for (ConfigurationItem& item : settings.configuration)
    if (item.key == demos::kChangeKey) item.value.replace(item.value.find("2000.0"), 6, "1e300");
  const std::jthread other([&](const std::stop_token& stop) {
    demos::PeerRun run(scenario, 1, settings, demos::makeOtherSites(line(2), 2));
    try {
      (void)run.waitForPeers(
          30.0, [&] { return stop.stop_requested(); }, [](const auto&) {});
    } catch (const demos::UsageError&) {
      // Site 1 has another configuration, as it is to have.
    }
  });
  start(1);
  waitFor([&] { return hasNote("contact.stiffness"); }, "a line on the refusal");
  EXPECT_EQ(sessions[0]->scenario().changes, 0u);
  EXPECT_EQ(sessions[0]->scenario().scenario.site.contact.stiffness, 2000.0);
}

TEST_F(PeerSessionTest, ARunThatIsRecordedEndsWithALine) {
  std::string said;
  std::jthread recorded([&] {
    demos::PeerMeeting meeting(scenario, line(2),
                               {nullptr, {}, demos::PeerPurpose::kResults, false});
    demos::PeerWatch watch;
    watch.stop = [] { return false; };
    watch.report = [](const demos::PeerReport&) {};
    watch.note = [](const std::string&) {};
    try {
      meeting.live(watch);
    } catch (const Error& error) {
      said = error.what();
    }
  });
  start(1);
  waitFor([&] { return isLive(0); }, "both to meet");
  sessions[0]->propose(with("experiment.scheme=kinematic_proxy"));
  recorded.join();
  EXPECT_NE(said.find("site 1 changes scheme or gains, and --out"), std::string::npos) << said;
}

TEST_F(PeerSessionTest, RefusesToProposeAnotherWorld) {
  start(1);
  EXPECT_THROW(sessions[0]->propose(with("world.gravity=1")), demos::UsageError);
  EXPECT_EQ(sessions[0]->scenario().changes, 0u);
}

}  // namespace
}  // namespace tandem::view
