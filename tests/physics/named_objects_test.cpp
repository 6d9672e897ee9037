// Objects that peers share by name, in different orders.

#include <memory>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tandem/coordination/simulated_link.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::FakeDevice;

const Vec3 kBallAt(0.0, 0.0, 0.0), kCubeAt(0.0, 0.5, 0.0);

/// A user with a body for each of two objects.
struct NamingUser {
  BulletRig rig;
  FakeDevice device{Vec3(10.0, 0.0, 0.0)};
  btRigidBody& ball = rig.addCube(0.2, 0.02, kBallAt);
  btRigidBody& cube = rig.addCube(0.2, 0.02, kCubeAt);
  std::unique_ptr<Site> site;

  explicit NamingUser(std::uint32_t self) {
    SiteSettings settings;
    settings.self = PeerId{self};
    site = std::make_unique<Site>(settings, rig.world, device);
  }
  static Vec3 place(const btRigidBody& body) { return fromBullet(body.getCenterOfMassPosition()); }
};

template <typename Call>
std::string reasonOf(Call call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(NamedObjects, ArePairedInAnyOrder) {
  NamingUser here(1), there(2);
  EXPECT_EQ(here.site->share({{"cube", &here.cube}, {"ball", &here.ball}}),
            (std::vector<ObjectId>{1, 0}));
  EXPECT_EQ(there.site->share({{"ball", &there.ball}, {"cube", &there.cube}}),
            (std::vector<ObjectId>{0, 1}));
  const auto links = makeSimulatedLinks({});
  here.site->connect(PeerId{2}, *links.first, Vec3(10.0, 0.0, 0.0));
  there.site->connect(PeerId{1}, *links.second, Vec3(10.0, 0.0, 0.0));
  here.ball.setLinearVelocity(btVector3(btScalar(0.2), 0, 0));
  for (int step = 0; step < 60; ++step) {
    here.rig.step(1.0 / 60.0);
    there.rig.step(1.0 / 60.0);
  }
  // The coupler of the copies brakes them, as packets hold its targets.
  EXPECT_GT(NamingUser::place(there.ball).x(), 3e-3);
  EXPECT_NEAR(NamingUser::place(here.ball).x(), NamingUser::place(there.ball).x(), 1e-3);
  EXPECT_LT((NamingUser::place(there.cube) - kCubeAt).norm(), 1e-6);
  EXPECT_LT((NamingUser::place(here.cube) - kCubeAt).norm(), 1e-6);
}

// Meshes compare the names, and say which one a site lacks.
TEST(NamedObjects, OtherNamesAreADifference) {
  const Configuration here = describeObjects({"cube", "ball"});
  EXPECT_EQ(here, describeObjects({"ball", "cube"}));
  const auto difference = findFirstDifference(here, describeObjects({"ball", "cup"}));
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->key, "object.cube");
  EXPECT_EQ(difference->here, "shared");
  EXPECT_EQ(difference->there, "");
}

TEST(NamedObjects, WhatCannotBeIsRefusedAndNothingIsShared) {
  NamingUser user(1);
  btRigidBody& fixed = user.rig.addCube(0.0, 0.02, Vec3(1.0, 0.0, 0.0));
  const auto reason = [&](const std::vector<NamedBody>& bodies) {
    return reasonOf([&] { user.site->share(bodies); });
  };
  EXPECT_NE(reason({{"a", &user.ball}, {"a", &user.cube}}).find("object.a"), std::string::npos);
  EXPECT_NE(reason({{"a", &user.ball}, {"b", &user.ball}}).find("the same body"),
            std::string::npos);
  EXPECT_NE(reason({{"a", &user.ball}, {"b c", &user.cube}}).find("object.b c"), std::string::npos);
  EXPECT_NE(reason({{"", &user.ball}}).find("1 to 57 characters"), std::string::npos);
  EXPECT_NE(reason({{"a", &user.ball}, {"b", nullptr}}).find("b has no body"), std::string::npos);
  EXPECT_NE(reason({{"a", &user.ball}, {"b", &fixed}}), "");
  EXPECT_EQ(user.site->objectCount(), 0);
  user.site->share(user.ball);
  EXPECT_NE(reason({{"b", &user.cube}}).find("before all others"), std::string::npos);
}

}  // namespace
}  // namespace tandem
