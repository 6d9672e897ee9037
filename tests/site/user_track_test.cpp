// Private header of the plugin: the position that a remote user counts as being at.
#include "plugin/src/site/user_track.h"

#include <gtest/gtest.h>

namespace tandem {
namespace {

const Vec3 kHere(0.1, 0, 0), kThere(0.2, 0, 0), kSpeed(0.5, 0, 0);

TEST(UserTrack, IsWhatWasHeard) {
  UserTrack track;
  track.jump({kHere, kSpeed});
  EXPECT_EQ(track.at(5.0, 1.0).p_W, kHere);
  EXPECT_EQ(track.at(5.0, 0.5).v_W, Vec3(0.25, 0, 0));
  track.hear({kThere, kSpeed}, 5.0, 0.0);
  EXPECT_EQ(track.at(5.0, 1.0).p_W, kThere);
  EXPECT_EQ(track.at(5.0, 1.0).v_W, kSpeed);
  EXPECT_FALSE(track.isMakingUp(5.0));
}

TEST(UserTrack, MakesUpForASilenceInAsLong) {
  UserTrack track;
  track.jump({kHere, Vec3::Zero()});
  track.hear({kThere, Vec3::Zero()}, 5.0, 0.2);
  EXPECT_NEAR((track.at(5.0, 1.0).p_W - kHere).norm(), 0.0, 1e-15);
  EXPECT_NEAR((track.at(5.1, 1.0).p_W - Vec3(0.15, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((track.at(5.1, 1.0).v_W - Vec3(0.5, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_TRUE(track.isMakingUp(5.19));
  // Packets that arrive in time move the user as they are.
  track.hear({kThere + Vec3(0, 0.01, 0), Vec3::Zero()}, 5.1, 0.0);
  EXPECT_NEAR((track.at(5.1, 1.0).p_W - Vec3(0.15, 0.01, 0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(track.at(5.3, 1.0).p_W, kThere + Vec3(0, 0.01, 0));
  EXPECT_EQ(track.at(5.3, 1.0).v_W, Vec3(0, 0, 0));
}

TEST(UserTrack, SecondSilenceStartsWhereItIs) {
  UserTrack track;
  track.jump({kHere, Vec3::Zero()});
  track.hear({kThere, Vec3::Zero()}, 5.0, 0.2);
  track.hear({kHere, Vec3::Zero()}, 5.1, 0.05);
  EXPECT_NEAR(track.at(5.1, 1.0).p_W.x(), 0.15, 1e-12);
  EXPECT_NEAR(track.at(5.125, 1.0).p_W.x(), 0.125, 1e-12);
  track.jump({kThere, Vec3::Zero()});
  EXPECT_EQ(track.at(5.11, 1.0).p_W, kThere);
}

}  // namespace
}  // namespace tandem
