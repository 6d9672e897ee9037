#include "tandem/bullet_bridge/bullet_abi.h"

#include <string>

#include <gtest/gtest.h>

#include "bridge/bullet_rig.h"

namespace tandem {
namespace {

std::string refusalOf(const BulletAbi& host) {
  try {
    checkBulletAbi(host);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(BulletAbi, AcceptsTheBulletItWasBuiltFor) { EXPECT_EQ(refusalOf(bulletAbiOfThisCode()), ""); }

TEST(BulletAbi, SeesTheWidthOfTheBulletThatIsLoaded) {
  // Uses Bullet, so that its library is loaded into the process.
  const test::BulletRig rig;
  const std::size_t loaded = loadedBulletScalarBytes();
  if (loaded == 0) GTEST_SKIP() << "Bullet is linked statically and exports nothing";
  EXPECT_EQ(loaded, sizeof(btScalar));
}

TEST(BulletAbi, FindsTheLibraryThatBringsAWidth) {
  const test::BulletRig rig;
  EXPECT_EQ(findOtherBulletWidth(sizeof(btScalar)), "");
  if (loadedBulletScalarBytes() == 0) GTEST_SKIP() << "Bullet is linked statically";
  // For a caller of another width, the library loaded here has the wrong width.
  const std::string found = findOtherBulletWidth(sizeof(btScalar) + 1);
  EXPECT_NE(found.find("libBulletDynamics"), std::string::npos) << found;
}

TEST(BulletAbi, RefusesAnotherWidthAndNamesTheLibraryToLink) {
  const bool is_double = sizeof(btScalar) == 8;
  const BulletAbi other{is_double ? std::size_t{4} : std::size_t{8}, BT_BULLET_VERSION};
  const std::string message = refusalOf(other);
  EXPECT_NE(message.find("8-byte (double)"), std::string::npos) << message;
  EXPECT_NE(message.find("4-byte (float)"), std::string::npos) << message;
  EXPECT_NE(message.find(is_double ? "link tandem::plugin instead of tandem::plugin_float64"
                                   : "link tandem::plugin_float64 instead of tandem::plugin"),
            std::string::npos)
      << message;
}

TEST(BulletAbi, RefusesAnotherVersionAndNamesBoth) {
  const std::string message = refusalOf({sizeof(btScalar), BT_BULLET_VERSION + 1});
  EXPECT_NE(message.find(std::to_string(BT_BULLET_VERSION)), std::string::npos) << message;
  EXPECT_NE(message.find(std::to_string(BT_BULLET_VERSION + 1)), std::string::npos) << message;
}

TEST(BulletAbi, IsCheckedWhenAWorldIsAttached) {
  test::BulletRig rig;
  test::Listener listener([](double) {}, [](double) {});
  EXPECT_THROW(HostWorld(rig.world, listener, {sizeof(btScalar) + 1, BT_BULLET_VERSION}), Error);
  EXPECT_NO_THROW(HostWorld(rig.world, listener));
}

}  // namespace
}  // namespace tandem
