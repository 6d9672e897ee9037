// A room of four users as a spectator sees it.

#include "watch/room_look.h"

#include <algorithm>
#include <array>
#include <string>

#include <gtest/gtest.h>

#include "view/own_world.h"
#include "view/watched_states.h"

namespace tandem::view {
namespace {

class RoomLookTest : public ::testing::Test {
 protected:
  /// A user's hand and cube, told often enough to be shown as they are at `until` [s].
  void tell(int user, double until, double hand_x, double cube_x, bool fits = true) {
    for (int i = 8; i >= 0; --i)
      room.take(user,
                states_[static_cast<std::size_t>(user)].next(until - i / 32.0, until - i / 32.0,
                                                             {{hand_x, 0, 0}, Vec3::Zero()},
                                                             Vec3(cube_x, 0, 0)),
                fits);
  }
  static const Solid* find(const SessionLook& look, const std::string& name, bool is_ghost) {
    const auto found = std::ranges::find_if(look.list.solids, [&](const Solid& solid) {
      return solid.name == name && solid.is_ghost == is_ghost;
    });
    return found == look.list.solids.end() ? nullptr : &*found;
  }
  static std::array<float, 3> colourOf(const Solid& solid) {
    return {solid.colour.red, solid.colour.green, solid.colour.blue};
  }
  static std::array<float, 3> colourOf(int user) {
    const Colour colour = chooseUserColour(user);
    return {colour.red, colour.green, colour.blue};
  }

  RoomLook room{tandem::test::loadWorld("rail", {"site=[{}, {}, {}, {}]"})};

 private:
  std::array<tandem::test::WatchedStates, 4> states_;
};

TEST_F(RoomLookTest, WaitsBeforeAnybodyIsHeard) {
  const SessionLook look = room.look(0.0, std::nullopt);
  EXPECT_TRUE(look.is_waiting);
  EXPECT_FALSE(look.followed);
  EXPECT_NE(find(look, "cube", false), nullptr);
}

TEST_F(RoomLookTest, ShowsOneUsersCopyAndTheOthersEdgesInTheirColours) {
  for (int user = 0; user < 4; ++user) tell(user, 1.0, 0.1 * user, 0.01 * user);
  const SessionLook look = room.look(1.0, 1);
  EXPECT_EQ(look.followed, 1);
  EXPECT_NEAR(find(look, "cube", false)->p_WB.x(), 0.01, 1e-9);
  EXPECT_EQ(std::ranges::count_if(look.list.solids,
                                  [](const Solid& s) { return s.name == "cube" && s.is_ghost; }),
            3);
  EXPECT_EQ(colourOf(*find(look, "cube", true)), colourOf(0));
  EXPECT_NEAR(look.apart, 0.02, 1e-9);
  for (int user = 0; user < 4; ++user) {
    const Solid* hand = find(look, "hand " + std::to_string(user + 1), false);
    ASSERT_NE(hand, nullptr);
    EXPECT_NEAR(hand->p_WB.x(), 0.1 * user, 1e-9);
    EXPECT_EQ(colourOf(*hand), colourOf(user));
  }
}

TEST_F(RoomLookTest, FollowsTheFirstWhoIsHeardUntilAnotherIsWanted) {
  tell(2, 1.0, 0.0, 0.03);
  tell(3, 1.0, 0.0, 0.05);
  EXPECT_EQ(room.look(1.0, std::nullopt).followed, 2);
  EXPECT_EQ(room.look(1.0, 0).followed, 2);
  EXPECT_EQ(room.look(1.0, 3).followed, 3);
}

// Bullet's bounds cover where it thinks that the body was, too.
TEST_F(RoomLookTest, DrawsBoundsWhereTheObjectIs) {
  tell(0, 1.0, 5.0, 0.5);
  WorldDetails details;
  details.bounds = true;
  const SessionLook look = room.look(1.0, 0, details);
  ASSERT_FALSE(look.list.lines.empty());
  for (const Line& line : look.list.lines) EXPECT_GT(line.from_W.x(), 0.4);
}

TEST_F(RoomLookTest, FadesASilentUserAndBringsHimBack) {
  tell(0, 1.0, 0.0, 0.01);
  tell(1, 2.0, 0.0, 0.0);
  const SessionLook faded = room.look(2.0, 0);
  EXPECT_FALSE(faded.users[0].is_live);
  EXPECT_NEAR(faded.users[0].age, 1.0, 1e-9);
  EXPECT_NE(colourOf(*find(faded, "hand 1", false)), colourOf(0));
  EXPECT_EQ(colourOf(*find(faded, "hand 2", false)), colourOf(1));
  const auto faded_cube = colourOf(*find(faded, "cube", false));
  tell(0, 3.0, 0.0, 0.01);
  const SessionLook back = room.look(3.0, 0);
  EXPECT_TRUE(back.users[0].is_live);
  EXPECT_EQ(colourOf(*find(back, "hand 1", false)), colourOf(0));
  EXPECT_NE(colourOf(*find(back, "cube", false)), faded_cube);
}

TEST_F(RoomLookTest, ShowsNothingOfAUserWithAnotherScenario) {
  tell(0, 1.0, 0.0, 0.5, false);
  tell(1, 1.0, 0.0, 0.0);
  const SessionLook look = room.look(1.0, 0);
  EXPECT_EQ(look.followed, 1);
  EXPECT_TRUE(look.users[0].has_another_scenario);
  EXPECT_EQ(find(look, "hand 1", false), nullptr);
  EXPECT_EQ(find(look, "cube", true), nullptr);
}

}  // namespace
}  // namespace tandem::view
