// Calls that the door refuses, case by case in refused_*_test.cpp: the result, the message, and no
// change.

#include "c_door/refusal_rig.h"

namespace tandem {
namespace test {

TEST_P(Refused, SaysWhyAndChangesNothing) {
  Scene scene;
  const std::vector<double> before = scene.look();
  const TandemResult result = GetParam().call(scene);
  const std::string words = tandem_last_error();
  EXPECT_STREQ(tandem_result_name(result), tandem_result_name(GetParam().result)) << words;
  EXPECT_NE(words.find(GetParam().words), std::string::npos) << words;
  EXPECT_EQ(words.find('\n'), std::string::npos);
  EXPECT_EQ(scene.look(), before);
  // The world still steps.
  ok(tandem_world_step(scene.world, 1.0 / 60.0, 0, 0.0));
  EXPECT_EQ(scene.read().ticks, 34u);
}

}  // namespace test

namespace {

using namespace test;

TEST(LastError, IsCutAtAWholeCharacter) {
  std::string path;
  for (int i = 0; i < 600; ++i) path += "\u00e4";
  EXPECT_EQ(tandem_key_create(("/nowhere/" + path).c_str()), TANDEM_INVALID_ARGUMENT);
  const std::string words = tandem_last_error();
  EXPECT_LE(words.size(), 512u);
  EXPECT_GE(words.size(), 510u);
  EXPECT_NE(words.back(), '\xc3');
}

TEST(ResultNames, AreThoseOfTheHeader) {
  EXPECT_STREQ(tandem_result_name(TANDEM_OK), "TANDEM_OK");
  EXPECT_STREQ(tandem_result_name(TANDEM_IN_USE), "TANDEM_IN_USE");
  EXPECT_STREQ(tandem_result_name(TANDEM_INTERNAL), "TANDEM_INTERNAL");
}

TEST(Version, IsTheProjects) { EXPECT_STREQ(tandem_version(), TANDEM_VERSION); }

TEST(DestroyingNull, DoesNothing) {
  EXPECT_EQ(tandem_world_destroy(nullptr), TANDEM_OK);
  EXPECT_EQ(tandem_device_destroy(nullptr), TANDEM_OK);
  EXPECT_EQ(tandem_link_destroy(nullptr), TANDEM_OK);
  EXPECT_EQ(tandem_mesh_destroy(nullptr), TANDEM_OK);
  EXPECT_EQ(tandem_site_destroy(nullptr), TANDEM_OK);
}

}  // namespace
}  // namespace tandem
