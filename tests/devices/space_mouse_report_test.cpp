#include "falcon/src/hid/space_mouse_report.h"

#include <gtest/gtest.h>

#include "devices/fake_hid_port.h"

namespace tandem {
namespace {

using test::Bytes;

SpaceMouseNews take(const Bytes& bytes, SpaceMouseState& state) {
  return takeSpaceMouseReport(bytes.data(), bytes.size(), state);
}

TEST(SpaceMouseReport, OldLayoutTellsPlaceAndTurnInTurn) {
  SpaceMouseState state;
  EXPECT_EQ(take({1, 0x5E, 0x01, 0x51, 0xFF, 0x00, 0x00}, state), SpaceMouseNews::kPlace);
  EXPECT_EQ(take({2, 0x00, 0x00, 0x23, 0x00, 0xA2, 0xFE}, state), SpaceMouseNews::kTurn);
  EXPECT_EQ(state.axes, (std::array{1.0, -0.5, 0.0, 0.0, 0.1, -1.0}));
}

TEST(SpaceMouseReport, NewLayoutTellsBothAtOnce) {
  SpaceMouseState state;
  EXPECT_EQ(take({1, 0x5E, 0x01, 0x51, 0xFF, 0, 0, 0, 0, 0x23, 0x00, 0xA2, 0xFE}, state),
            SpaceMouseNews::kBoth);
  EXPECT_EQ(state.axes, (std::array{1.0, -0.5, 0.0, 0.0, 0.1, -1.0}));
}

TEST(SpaceMouseReport, AxesBeyondFullAreFull) {
  SpaceMouseState state;
  EXPECT_EQ(take({1, 0xFF, 0x7F, 0x00, 0x80, 0x5F, 0x01}, state), SpaceMouseNews::kPlace);
  EXPECT_EQ(state.axes, (std::array{1.0, -1.0, 1.0, 0.0, 0.0, 0.0}));
}

TEST(SpaceMouseReport, ButtonsAreBitsOfOneToMoreThanFourBytes) {
  SpaceMouseState state;
  EXPECT_EQ(take({3, 0x02}, state), SpaceMouseNews::kButtons);
  EXPECT_EQ(state.buttons, 2U);
  EXPECT_EQ(take({3, 0x01, 0x00, 0x00, 0x80}, state), SpaceMouseNews::kButtons);
  EXPECT_EQ(state.buttons, 0x80000001U);
  EXPECT_EQ(take({3, 1, 2, 3, 4, 5, 6}, state), SpaceMouseNews::kButtons);
  EXPECT_EQ(state.buttons, 0x04030201U);
}

TEST(SpaceMouseReport, BatteryChangesNothing) {
  SpaceMouseState state;
  EXPECT_EQ(take({0x17, 0x50}, state), SpaceMouseNews::kNothing);
  EXPECT_EQ(state.axes, SpaceMouseState{}.axes);
}

TEST(SpaceMouseReport, EverythingElseIsRefusedAndChangesNothing) {
  SpaceMouseState state;
  ASSERT_EQ(take({1, 1, 0, 2, 0, 3, 0}, state), SpaceMouseNews::kPlace);
  const SpaceMouseState before = state;
  for (int id = 0; id < 256; ++id) {
    for (std::size_t size = 0; size <= 64; ++size) {
      Bytes bytes(size, 0x55);
      if (size > 0) bytes[0] = static_cast<std::uint8_t>(id);
      const bool is_known = (id == 1 && (size == 7 || size == 13)) || (id == 2 && size == 7) ||
                            ((id == 3 || id == 0x17) && size >= 2);
      if (is_known) continue;
      ASSERT_EQ(take(bytes, state), SpaceMouseNews::kRefused) << id << " of " << size;
    }
  }
  EXPECT_EQ(state.axes, before.axes);
  EXPECT_EQ(state.buttons, before.buttons);
}

TEST(SpaceMouseReport, ASpaceMouseIsKnownByIdsAndUsage) {
  EXPECT_TRUE(isSpaceMouse({0x256F, 0xC635, 1, 8, 0, "", ""}));
  EXPECT_TRUE(isSpaceMouse({0x046D, 0xC626, 1, 8, 0, "", ""}));
  EXPECT_FALSE(isSpaceMouse({0x256F, 0xC635, 1, 6, 0, "", ""})) << "its keyboard";
  EXPECT_FALSE(isSpaceMouse({0x256F, 0xC650, 1, 8, 0, "", ""})) << "a mouse of the same maker";
  EXPECT_FALSE(isSpaceMouse({0x046D, 0xC635, 1, 8, 0, "", ""})) << "the other maker's number";
}

}  // namespace
}  // namespace tandem
