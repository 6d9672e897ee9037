// A live session of both sites, and one that goes on from there. No wall time is asserted.

#include "session/live_session.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/falcon/mouse_device.h"

namespace tandem::view {
namespace {

demos::Scenario loadCube() {
  return demos::loadScenario(std::filesystem::path(TANDEM_WORLDS) / "cube.toml",
                             {"site2.hand_waypoints=[[0,0,0,0]]", "object.mass=0.4"});
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

TEST(LiveSession, IsFeltAndGoesOnFromWhereItWas) {
  demos::Scenario scenario = loadCube();
  MouseDevice mouse = makeMouse(scenario);
  LiveSession session(scenario, mouse);
  push(session, mouse, 0.02);
  EXPECT_EQ(session.look()->status, kTickOk);
  const SessionPlaces places = session.end();

  scenario.scheme = "kinematic_proxy";
  startHandsAt(places, scenario);
  const demos::SceneFrame frame = demos::makeSceneFrame(scenario);
  for (int user : {0, 1}) {
    const Vec3 start_W = demos::computeStart(scenario, frame, user);
    EXPECT_LT((start_W - places.hands_W[static_cast<std::size_t>(user)]).norm(), 1e-12);
  }
  MouseDevice again = makeMouse(scenario);
  const LiveSession next(scenario, again, places.bodies);
  // Before the first tick, or not long after.
  const auto look = next.look();
  EXPECT_LT((look->object_W - places.bodies.at("cube").p_W).norm(), 2e-3);
  EXPECT_LT((look->hip_W - places.hands_W[0]).norm(), 1e-2);
  EXPECT_GT(look->object_W.x(), 0.019);
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

}  // namespace
}  // namespace tandem::view
