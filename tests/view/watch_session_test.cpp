// A spectator's session in one process with a relay and a site, over UDP on the loopback. No wall
// time is asserted.

#include "watch/watch_session.h"

#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/plugin/key_file.h"
#include "tandem/plugin/relay.h"

#include "support/temp_folder.h"
#include "terminal/usage_error.h"
#include "view/own_world.h"

namespace tandem::view {
namespace {

/// A relay in a thread of its own.
class RelayThread {
 public:
  explicit RelayThread(const std::string& key)
      : relay_({resolveAddress("127.0.0.1:0")}, readKeyFile(key)),
        thread_([this](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            relay_.wait(0.01);
            relay_.poll(readMonotonicClock());
          }
        }) {}
  [[nodiscard]] std::string address() const {
    return "127.0.0.1:" + std::to_string(relay_.bound().port);
  }

 private:
  RelayServer relay_;
  std::jthread thread_;
};

class WatchSessionTest : public ::testing::Test {
 protected:
  WatchSessionTest() {
    for (const std::string& key : {relay_key_, watch_key_}) makeKeyFile(key);
    relay_.emplace(relay_key_);
    line.relay = relay_->address();
    line.relay_key = relay_key_;
    line.watch_key = watch_key_;
  }

  /// A site that says where its hand is, until the test ends.
  void startSite(const demos::Scenario& of) {
    demos::PeerLine own = line;
    own.site = 1;
    own.bind = "127.0.0.1:0";
    own.keys = {relay_key_};  // of a pair: any
    site_ = std::jthread([this, own, of](const std::stop_token& stop) {
      UdpMesh mesh(demos::makeMeshSettings(own, {of, 0}), demos::makeOtherSites(own, 2),
                   demos::makeRelayAccess(own));
      StatePacket packet;
      packet.sender = PeerId{1};
      packet.user.p_W.x() = 0.25;
      for (; !stop.stop_requested(); ++packet.sequence) {
        const double now = readMonotonicClock();
        packet.time = now;
        mesh.poll(now);
        if (!is_paused) mesh.link(PeerId{2}).send(packet, now);
        sleepFor(0.005);
      }
    });
  }
  template <typename Condition>
  static void waitFor(const Condition& holds, const char* what) {
    for (int turn = 0; !holds(); ++turn) {
      ASSERT_LT(turn, 3000) << "waited in vain for " << what;
      sleepFor(0.01);
    }
  }
  /// What ends a session.
  static std::string endOf(const WatchSession& session) {
    try {
      waitFor([&] { return !session.goesOn(); }, "the end");
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }

  demos::Scenario scenario = tandem::test::loadWorld("rail");
  demos::PeerLine line;
  std::atomic<bool> is_paused = false;

 private:
  tandem::test::TempFolder folder_;
  std::string relay_key_ = folder_ / "relay", watch_key_ = folder_ / "watch";
  std::optional<RelayThread> relay_;
  std::jthread site_;
};

TEST_F(WatchSessionTest, ShowsASiteAlsoAfterASilence) {
  const WatchSession session(scenario, line);
  EXPECT_TRUE(session.look()->is_waiting);
  startSite(scenario);
  const auto is_live = [&] {
    const auto look = session.look();
    return session.goesOn() && !look->users.empty() && look->users[0].is_live;
  };
  waitFor(is_live, "the site");
  EXPECT_EQ(session.look()->followed, 0);
  const auto shows_hand = [&] { return std::abs(session.look()->hip_W.x() - 0.25) < 1e-9; };
  waitFor(shows_hand, "the hand");
  is_paused = true;
  waitFor([&] { return !is_live(); }, "the silence");
  EXPECT_TRUE(shows_hand());
  is_paused = false;
  waitFor(is_live, "the site again");
}

TEST_F(WatchSessionTest, EndsWithALineIfTheSitesHaveAnotherScenario) {
  const WatchSession session(scenario, line);
  startSite(demos::changeScenario(scenario, {"object.size=0.05"}));
  EXPECT_NE(endOf(session).find("site 1 has another scenario"), std::string::npos);
}

TEST_F(WatchSessionTest, EndsWithALineIfNobodyIsHeard) {
  line.patience = 0.2;
  const WatchSession session(scenario, line);
  EXPECT_NE(endOf(session).find("no site was heard for 0.2 s"), std::string::npos);
}

TEST_F(WatchSessionTest, NeedsAllKeys) {
  line.relay_key.clear();
  EXPECT_THROW(WatchSession(scenario, line), demos::UsageError);
}

}  // namespace
}  // namespace tandem::view
