// A live session of both sites, and one that goes on from there. No wall time is asserted.

#include "session/live_session.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/falcon/mouse_device.h"

#include "device/gamepad_driver.h"
#include "device/user_axes.h"
#include "devices/fake_event_port.h"
#include "replay/run_replay.h"
#include "scenario/keys.h"
#include "support/temp_folder.h"
#include "view/own_world.h"

namespace tandem::view {
namespace {

demos::Scenario loadCube() {
  return tandem::test::loadWorld("cube", {"site2.hand_waypoints=[[0,0,0,0]]", "object.mass=0.4"});
}

MouseDevice makeMouse(const demos::Scenario& scenario) {
  MouseSettings settings;
  settings.start_W = demos::computeStart(scenario, demos::makeSceneFrame(scenario), 0);
  return MouseDevice(settings);
}

/// Pushes the cube until it has moved by `way` [m].
void push(LiveSession& session, MouseDevice& mouse, double way) {
  const Vec3 from_W = mouse.target();
  for (int i = 0; session.look()->object_W.x() < way; ++i) {
    mouse.moveTo(from_W + Vec3(1e-3 * std::min(i, 150), 0.0, 0.0), 0.01 * i);
    sleepFor(0.01);
    ASSERT_LT(i, 3000) << "the cube does not move";
  }
}

/// Waits until time stands still after the tick `before`. Returns the ticks until then.
std::uint64_t waitForPause(const LiveSession& session, std::uint64_t before = 0) {
  std::uint64_t last = before;
  for (int still = 0; still < 25;) {
    sleepFor(0.02);
    const std::uint64_t now = session.look()->loop.ticks;
    still = now == last && now != before ? still + 1 : 0;
    last = now;
  }
  return last;
}

TEST(LiveSession, IsFeltAndGoesOnFromWhereItWas) {
  demos::Scenario scenario = loadCube();
  MouseDevice mouse = makeMouse(scenario);
  LiveSession session(scenario, mouse);
  push(session, mouse, 0.02);
  EXPECT_EQ(session.look()->status, kTickOk);
  const demos::ScenePlaces places = session.end();

  scenario.scheme = "kinematic_proxy";
  demos::startHandsAt(places, scenario);
  const demos::SceneFrame frame = demos::makeSceneFrame(scenario);
  for (int user : {0, 1}) {
    const Vec3 start_W = demos::computeStart(scenario, frame, user);
    EXPECT_LT((start_W - places.hands_W[static_cast<std::size_t>(user)]).norm(), 1e-12);
  }
  MouseDevice again = makeMouse(scenario);
  const LiveSession next(scenario, again, {.places = places.bodies});
  // Before the first tick, or not long after.
  const auto look = next.look();
  EXPECT_LT((look->object_W - places.bodies.at("cube").p_W).norm(), 2e-3);
  EXPECT_LT((look->hip_W - places.hands_W[0]).norm(), 1e-2);
  EXPECT_GT(look->object_W.x(), 0.019);
}

// User 2's gamepad holds an end of the plank by its button, and lifts it with its stick.
TEST(LiveSession, ASecondDeviceIsUser2sHand) {
  const demos::Scenario scenario = tandem::test::loadWorld("plank");
  const demos::SceneFrame frame = demos::makeSceneFrame(scenario);
  const Vec3 start_W = demos::computeStart(scenario, frame, 1);
  tandem::test::FakeEventDevice pad;
  tandem::test::FakeEventDevice::makePad(pad);
  demos::LiveDevice second({demos::DeviceSpec::Kind::kGamepad, ""},
                           demos::makeGamepadDriver(pad.opener(), {}), {},
                           {demos::computeUserAxes(frame.q_WS, 0), start_W});
  second.holdUntilTicked(start_W);
  MouseDevice mouse = makeMouse(scenario);
  LiveSession session(scenario, mouse, {.second = &second});
  pad.tell(EV_KEY, BTN_SOUTH, 1);
  const double from = session.look()->object_W.z();
  for (int i = 0; session.look()->object_W.z() < from + 0.01; ++i) {
    if (i == 100) pad.tell(EV_ABS, ABS_RY, -32768);
    sleepFor(0.01);
    ASSERT_LT(i, 3000) << "the plank is not lifted";
  }
  EXPECT_EQ(session.look()->status, kTickOk);
  const demos::ScenePlaces places = session.end();
  EXPECT_GT(places.hands_W[1].z(), start_W.z() + 0.01);
}

TEST(LiveSession, TakesAnotherNetworkAndRefusesABadOne) {
  const demos::Scenario scenario = loadCube();
  MouseDevice mouse = makeMouse(scenario);
  LiveSession session(scenario, mouse);
  Impairments network;
  network.delay = 0.2;
  session.setNetwork(network);
  network.loss = 2.0;
  EXPECT_THROW(session.setNetwork(network), std::invalid_argument);
  EXPECT_TRUE(session.goesOn());
}

TEST(LiveSession, BulletsOwnContactGoesOnFromWhereTandemsWas) {
  demos::Scenario scenario = loadCube();
  MouseDevice mouse = makeMouse(scenario);
  LiveSession session(scenario, mouse);
  push(session, mouse, 0.02);
  const demos::ScenePlaces places = session.end();
  ASSERT_TRUE(places.areNear());

  for (const ContactModel model :
       {ContactModel::kNativeRigid, ContactModel::kNativeSoft, ContactModel::kSpring6Dof}) {
    demos::Scenario native = scenario;
    native.site.contact_model = model;
    native.host_rate = 240.0;
    demos::startHandsAt(places, native);
    MouseDevice again = makeMouse(native);
    LiveSession next(native, again, {.places = places.bodies});
    EXPECT_LT((next.look()->object_W - places.bodies.at("cube").p_W).norm(), 2e-3);
    const double from = next.look()->object_W.x();
    push(next, again, from + 0.01);
    EXPECT_EQ(next.look()->status, kTickOk) << demos::nameOf(model);
  }
}

// The hand is a body of Bullet's there. Drawn twice, in two colours at one place, it flickered.
TEST(LiveSession, TheHandInBulletsOwnContactIsNotDrawnAsABody) {
  demos::Scenario scenario = loadCube();
  const auto drawn = [&](ContactModel model) {
    scenario.site.contact_model = model;
    scenario.host_rate = 240.0;
    MouseDevice mouse = makeMouse(scenario);
    const LiveSession session(scenario, mouse);
    std::vector<std::string> names;
    for (const Solid& solid : session.look()->list.solids) names.push_back(solid.name);
    return names;
  };
  EXPECT_EQ(drawn(ContactModel::kNativeSoft), drawn(ContactModel::kIsland));
}

TEST(LiveSession, StandsStillWhilePausedAndStepsWhenAsked) {
  const demos::Scenario scenario = loadCube();
  MouseDevice mouse = makeMouse(scenario);
  LiveSession session(scenario, mouse);
  push(session, mouse, 0.02);
  session.setPace({1.0, true});
  // Haptic threads end, the forces settle, and then nothing changes.
  std::uint64_t ticks = waitForPause(session);
  const double force = session.look()->force_W.norm();
  EXPECT_GT(force, 0.1) << "the force that is shown came back after the threads had ended";
  sleepFor(0.2);
  EXPECT_EQ(session.look()->loop.ticks, ticks);
  session.step();
  const std::uint64_t after_step = waitForPause(session, ticks);
  EXPECT_GE(after_step, ticks + 16);
  EXPECT_LE(after_step, ticks + 17);
  session.setPace({});
  push(session, mouse, session.look()->object_W.x() + 0.005);
  EXPECT_EQ(session.look()->status, kTickOk);
}

TEST(LiveSession, LeavesARecordThatIsShownAgain) {
  const tandem::test::TempFolder folder;
  const demos::Scenario scenario = loadCube();
  MouseDevice mouse = makeMouse(scenario);
  SessionRecords records(folder.path() / "run", 0);
  LiveSession session(scenario, mouse, {.records = &records});
  Impairments network;
  network.delay = 0.02;
  session.setNetwork(network);
  push(session, mouse, 0.02);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "run" / "site1.json"))
      << "not before the end";
  const demos::ScenePlaces places = session.end();
  EXPECT_EQ(records.count(), 1);
  RunReplay replay(loadRecordedRun(folder.path() / "run"), std::nullopt);
  EXPECT_EQ(replay.scenario().network.delay, 0.02);
  const SessionLook last = replay.look(replay.duration());
  EXPECT_GT(last.object_W.x(), 0.015);
  // A picture is at most 1/30 s old, and the hand is as new as the last tick.
  EXPECT_LT((last.object_W - places.bodies.at("cube").p_W).norm(), 0.01);
  EXPECT_LT((last.hip_W - places.hands_W[0]).norm(), 2e-3);
  const RunReplay other(loadRecordedRun(folder.path() / "run"), 1);
  EXPECT_GE(other.frames().size(), 2u);
  session.end();
  EXPECT_EQ(records.count(), 1) << "stored once";
}

}  // namespace
}  // namespace tandem::view
