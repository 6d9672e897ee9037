// What a user may change of a session, and what is refused.

#include "session/session_control.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include <gtest/gtest.h>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/plugin/key_file.h"

#include "peer/users_device.h"
#include "replay/run_replay.h"
#include "support/checkout.h"
#include "support/temp_folder.h"
#include "terminal/usage_error.h"
#include "view/own_world.h"

namespace tandem::view {
namespace {

using tandem::test::loadWorld;

bool hasNote(const SessionControl& control, const std::string& text) {
  return std::ranges::any_of(control.notes(), [&](const std::string& note) {
    return note.find(text) != std::string::npos;
  });
}

SessionWishes wishesOf(const SessionControl& control) {
  SessionWishes wishes;
  wishes.scenario = control.scenario();
  wishes.pace = control.pace();
  return wishes;
}

SessionWishes wishContact(const SessionControl& control, ContactModel model) {
  SessionWishes wishes = wishesOf(control);
  wishes.scenario.site.contact_model = model;
  wishes.changes_sites = true;
  return wishes;
}

/// A pause, Bullet's own contact and another world are refused, each with its note.
void expectRefusals(SessionControl& control, const char* pause, const char* contact,
                    const char* world) {
  SessionWishes wishes = wishesOf(control);
  wishes.pace.is_paused = true;
  control.obey(wishes);
  EXPECT_TRUE(hasNote(control, pause));
  EXPECT_FALSE(control.pace().is_paused);
  control.obey(wishContact(control, ContactModel::kNativeSoft));
  EXPECT_TRUE(hasNote(control, contact));
  wishes = wishesOf(control);
  wishes.world = "rail";
  control.obey(wishes);
  EXPECT_TRUE(hasNote(control, world));
  EXPECT_EQ(control.scenario().site.contact_model, ContactModel::kIsland);
}

void waitForTicks(const SessionControl& control, std::uint64_t ticks = 10) {
  while (control.session().look()->loop.ticks < ticks) sleepFor(1e-3);
}

/// Long enough for two pictures.
void waitForRecord(const SessionControl& control) {
  while (control.session().look()->time < 0.05) sleepFor(1e-3);
}

TEST(SessionControl, SwitchesContactAndKeepsThePause) {
  SessionControl control(loadWorld("cube"), std::nullopt, {});
  waitForTicks(control);
  SessionWishes wishes = wishesOf(control);
  wishes.pace.is_paused = true;
  control.obey(wishes);
  for (const ContactModel model : {ContactModel::kNativeSoft, ContactModel::kIsland}) {
    control.obey(wishContact(control, model));
    EXPECT_EQ(control.scenario().site.contact_model, model);
    EXPECT_TRUE(control.pace().is_paused);
    waitForTicks(control);
    EXPECT_LT(control.session().look()->object_W.norm(), 5e-3) << "the cube is where it was";
  }
}

TEST(SessionControl, RefusesWhatBulletCannotDoAndGoesOn) {
  SessionControl control(loadWorld("touch"), std::nullopt, {});
  control.obey(wishContact(control, ContactModel::kNativeSoft));
  SessionWishes wishes = wishesOf(control);
  wishes.scenario.scheme = "kinematic_proxy";
  wishes.changes_sites = true;
  control.obey(wishes);
  EXPECT_TRUE(hasNote(control, "two kinematic spheres do not touch"));
  EXPECT_EQ(control.scenario().scheme, "remote_dynamic_proxy");
  EXPECT_TRUE(control.session().goesOn());
  // The next wish that can be had takes the line away.
  control.obey(wishContact(control, ContactModel::kIsland));
  EXPECT_FALSE(hasNote(control, "two kinematic spheres"));
}

// Worlds with joints, meshes, heaps and compounds: Bullet may do worse, but the window goes on.
TEST(SessionControl, EveryWorldTakesBulletsContactOrRefusesItAndComesBack) {
  for (const auto& entry :
       std::filesystem::directory_iterator(tandem::test::inCheckout("demos/worlds"))) {
    if (entry.path().extension() != ".toml") continue;
    const std::string world = entry.path().stem();
    SCOPED_TRACE(world);
    SessionControl control(loadWorld(world), std::nullopt, {});
    waitForTicks(control);
    for (const ContactModel model : {ContactModel::kNativeSoft, ContactModel::kIsland}) {
      control.obey(wishContact(control, model));
      const bool is_taken = control.scenario().site.contact_model == model;
      EXPECT_TRUE(is_taken || hasNote(control, world + ".toml: "));
      waitForTicks(control);
      EXPECT_TRUE(control.session().goesOn());
    }
    EXPECT_EQ(control.session().look()->status, kTickOk);
    EXPECT_EQ(control.scenario().site.contact_model, ContactModel::kIsland);
  }
}

TEST(SessionControl, RefusesMoreThanTwoSites) {
  const demos::Scenario scenario = loadWorld("rail", {"site=[{}, {}, {}]"});
  try {
    SessionControl control(scenario, std::nullopt, {});
    ADD_FAILURE() << "not refused";
  } catch (const demos::UsageError& error) {
    const std::string line = error.what();
    EXPECT_NE(line.find("has 3 sites"), std::string::npos) << line;
    EXPECT_NE(line.find("tandem run"), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
}

TEST(SessionControl, DoesNotStopASecondUsersHand) {
  const demos::Scenario scenario = loadWorld("cube");
  demos::DeviceOptions options;
  options.device = "simulated";
  bool is_ended = false;
  const auto second = demos::openSecondDevice(
      options, scenario, true, [](double) { return false; }, is_ended);
  ASSERT_FALSE(is_ended);
  SessionControl control(scenario, std::nullopt, {nullptr, second.get()});
  expectRefusals(control, "a real hand does not stop", "no haptic rate for a device",
                 "rail: a device has its place");
}

// Another scheme and Reset end a record, and the next one begins. A world that stands still has
// one.
TEST(SessionControl, ARecordForEachSession) {
  const tandem::test::TempFolder folder;
  const auto recordOf = [&](const char* name) {
    return RunReplay(loadRecordedRun(folder.path() / name), std::nullopt);
  };
  SessionControl control(loadWorld("rail"), std::nullopt, {}, folder.path() / "run");
  waitForRecord(control);
  SessionWishes wishes = wishesOf(control);
  wishes.scenario.scheme = "kinematic_proxy";
  wishes.changes_sites = true;
  control.obey(wishes);
  EXPECT_EQ(recordOf("run").scenario().scheme, "remote_dynamic_proxy");
  waitForRecord(control);
  wishes = wishesOf(control);
  wishes.restarts = true;
  wishes.pace.is_paused = true;
  control.obey(wishes);
  EXPECT_EQ(recordOf("run-2").scenario().scheme, "kinematic_proxy");
  waitForTicks(control, 20);
  sleepFor(0.05);
  wishes.restarts = false;
  wishes.steps = 4;
  control.obey(wishes);
  waitForRecord(control);
  control.end();
  EXPECT_GE(recordOf("run-3").frames().size(), 2u);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "run-4"));
}

TEST(SessionControl, RefusesAFolderForRecordsThatIsInUse) {
  const tandem::test::TempFolder folder;
  const demos::OutputFolder other(folder.path(), "--out");
  EXPECT_THROW(SessionControl(loadWorld("cube"), std::nullopt, {}, folder.path()),
               demos::UsageError);
}

// Nobody is at the other end: the session waits meanwhile.
TEST(SessionControl, DoesNotStopAFriendsTime) {
  const tandem::test::TempFolder folder;
  const std::string key = folder / "key";
  makeKeyFile(key);
  demos::PeerLine line;
  line.site = 1;
  line.bind = "127.0.0.1:0";
  line.peers = {"127.0.0.1:9"};
  line.keys = {key};
  SessionControl control(loadWorld("cube"), line, {});
  expectRefusals(control, "your friend's hand does not stop", "by Tandem's own contact only",
                 "rail: your friend is in this world");
}

TEST(SessionControl, ABodyThatFlewApartBeginsAnew) {
  SessionControl control(loadWorld("cube"), std::nullopt, {});
  control.obey(wishContact(control, ContactModel::kPointToPoint));
  for (int i = 0; control.session().look()->status == kTickOk; ++i) {
    ASSERT_LT(i, 3000) << "point joints do not diverge any more: use another way to fly apart";
    sleepFor(0.01);
  }
  control.obey(wishContact(control, ContactModel::kIsland));
  waitForTicks(control);
  EXPECT_EQ(control.session().look()->status, kTickOk);
  EXPECT_LT(control.session().look()->object_W.norm(), 0.01);
}

}  // namespace
}  // namespace tandem::view
