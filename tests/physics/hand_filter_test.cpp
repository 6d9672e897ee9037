// The hand feels what Bullet's filters and its own group and mask let it meet, and moving bodies
// also with nothing shared.

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::FakeDevice;
using test::FakeLink;

constexpr double kStep = 1.0 / 240.0;
constexpr int kLayer = 64;

/// Contacts that begin deep are let in gently, and free bodies give way: less than K times 2 mm
/// [N].
constexpr double kFelt = 0.1;

/// A hand at the origin, and a body whose face is 2 mm inside of the hand's sphere.
struct TouchingHand {
  BulletRig rig;
  FakeDevice device;
  FakeLink link;
  SiteSettings settings;
  std::optional<Site> site;

  static constexpr double kHalf = 0.02;
  static Vec3 beside() { return Vec3(kHalf + SiteSettings{}.hip_radius - 0.002, 0, 0); }

  btRigidBody& addCube(double mass) { return rig.addCube(mass, kHalf, beside()); }

  /// The same cube as a mesh of its surface.
  btRigidBody& addMesh() {
    meshes_.push_back(std::make_unique<btTriangleMesh>());
    const auto corner = [&](double y, double z) { return toBullet(Vec3(-kHalf, y, z)); };
    meshes_.back()->addTriangle(corner(-kHalf, -kHalf), corner(-kHalf, kHalf),
                                corner(kHalf, kHalf));
    meshes_.back()->addTriangle(corner(-kHalf, -kHalf), corner(kHalf, kHalf),
                                corner(kHalf, -kHalf));
    return rig.addBody(rig.makeShape<btBvhTriangleMeshShape>(meshes_.back().get(), true), 0.0,
                       beside());
  }

  btRigidBody& addKinematic() {
    btRigidBody& body = addCube(0.0);
    rig.world.removeRigidBody(&body);
    body.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    body.setActivationState(DISABLE_DEACTIVATION);
    rig.world.addRigidBody(&body);
    return body;
  }

  void refilter(btRigidBody& body, int group, int mask) {
    rig.world.removeRigidBody(&body);
    rig.world.addRigidBody(&body, group, mask);
  }

  Site& attach() {
    settings.hip_radius = SiteSettings{}.hip_radius;
    return site.emplace(settings, rig.world, device);
  }

  /// The largest force that the hand feels in some host steps [N].
  double feel(int steps = 12) {
    if (!site) attach();
    double most = 0.0;
    for (int i = 0; i < steps; ++i) {
      rig.step(kStep);
      most = std::max(most, site->force().norm());
    }
    return most;
  }

 private:
  std::vector<std::unique_ptr<btTriangleMesh>> meshes_;
};

enum class Kind { kFixed, kMesh, kKinematic, kNeighbour, kShared };

const char* nameOf(Kind kind) {
  constexpr const char* kNames[] = {"Fixed", "Mesh", "Kinematic", "Neighbour", "Shared"};
  return kNames[static_cast<int>(kind)];
}

class FilteredHand : public ::testing::TestWithParam<Kind> {
 protected:
  btRigidBody& addTouched() {
    switch (GetParam()) {
      case Kind::kFixed:
        return scene_.addCube(0.0);
      case Kind::kMesh:
        return scene_.addMesh();
      case Kind::kKinematic:
        return scene_.addKinematic();
      default:
        return scene_.addCube(0.3);
    }
  }
  double feel(int group, int mask) {
    btRigidBody& body = addTouched();
    scene_.refilter(body, group, mask);
    Site& site = scene_.attach();
    if (GetParam() == Kind::kShared) site.share(body);
    return scene_.feel();
  }
  TouchingHand scene_;
};

TEST_P(FilteredHand, FeelsBulletsDefaultGroups) {
  addTouched();
  Site& site = scene_.attach();
  if (GetParam() == Kind::kShared) site.share(*scene_.rig.bodies.front());
  EXPECT_GT(scene_.feel(), kFelt);
}

TEST_P(FilteredHand, PassesABodyWhoseMaskLeavesItOut) {
  EXPECT_EQ(feel(kLayer, kLayer), 0.0);
  EXPECT_EQ(scene_.site->neighbourCount(), 0);
}

TEST_P(FilteredHand, PassesABodyThatItsOwnMaskLeavesOut) {
  scene_.settings.hand_mask = ~kLayer;
  EXPECT_EQ(feel(kLayer, -1), 0.0);
}

TEST_P(FilteredHand, FeelsABodyOfItsOwnLayer) {
  scene_.settings.hand_group = scene_.settings.hand_mask = kLayer;
  EXPECT_GT(feel(kLayer, kLayer), kFelt);
}

TEST_P(FilteredHand, FollowsAFilterThatTheHostChanges) {
  if (GetParam() == Kind::kShared) scene_.settings.peers = 1;
  EXPECT_EQ(feel(kLayer, kLayer), 0.0);
  btRigidBody& body = *scene_.rig.bodies.front();
  scene_.refilter(body, 1, -1);
  EXPECT_GT(scene_.feel(120), kFelt);
}

INSTANTIATE_TEST_SUITE_P(Kinds, FilteredHand,
                         ::testing::Values(Kind::kFixed, Kind::kMesh, Kind::kKinematic,
                                           Kind::kNeighbour, Kind::kShared),
                         [](const auto& kind) { return nameOf(kind.param); });

// A change in place, without removal: the site is quiet by then.
TEST(HandAtRest, FollowsAMaskThatIsChangedInPlace) {
  TouchingHand scene;
  btRigidBody& wall = scene.addCube(0.0);
  EXPECT_GT(scene.feel(60), kFelt);
  wall.getBroadphaseHandle()->m_collisionFilterMask = kLayer;
  scene.feel(60);
  EXPECT_EQ(scene.site->force().norm(), 0.0);
}

TEST(RemoteHand, HasTheGroupAndMaskOfTheHand) {
  TouchingHand scene;
  scene.settings.hand_group = 2 * kLayer;
  scene.settings.hand_mask = kLayer;
  Site& site = scene.attach();
  site.connect(PeerId{2}, scene.link, Vec3(1.0, 0, 0));
  const btBroadphaseProxy& proxy = *site.proxyBody(0)->getBroadphaseHandle();
  EXPECT_EQ(proxy.m_collisionFilterGroup, 2 * kLayer);
  EXPECT_EQ(proxy.m_collisionFilterMask, kLayer);
}

TEST(HandAlone, PushesAMovingBody) {
  TouchingHand scene;
  btRigidBody& body = scene.addCube(0.3);
  EXPECT_GT(scene.feel(), kFelt);
  EXPECT_EQ(scene.site->neighbourCount(), 1);
  scene.feel(60);
  EXPECT_GT(body.getWorldTransform().getOrigin().x(), TouchingHand::beside().x() + 0.001);
}

TEST(HandAlone, PushesAMovingBodyOnceItsCallerTicks) {
  TouchingHand scene;
  scene.settings.tick_source = TickSource::kCaller;
  scene.addCube(0.3);
  Site& site = scene.attach();
  for (int i = 0; i < 100; ++i) scene.rig.step(kStep);
  EXPECT_EQ(site.neighbourCount(), 0) << "nobody ticks yet";
  double most = 0.0;
  for (int tick = 0; tick < 100; ++tick) {
    site.tick(100 * kStep + tick * 1e-3);
    most = std::max(most, site.force().norm());
    if (tick % 4 == 3) scene.rig.step(4e-3);
  }
  EXPECT_GT(most, kFelt);
}

TEST(HandAlone, FeelsFixedBodiesOnlyIfToldSo) {
  TouchingHand scene;
  scene.settings.hand_feels_moving_bodies = false;
  const btTransform before = scene.addCube(0.3).getWorldTransform();
  EXPECT_EQ(scene.feel(60), 0.0);
  EXPECT_EQ(scene.rig.bodies.front()->getWorldTransform(), before);
}

TEST(HandAlone, GivesABodyBackWhenItGoes) {
  TouchingHand scene;
  scene.addCube(0.3);
  scene.feel(4);
  EXPECT_EQ(scene.site->neighbourCount(), 1);
  scene.device.sample.hip.p_W = Vec3(0, 0, 1.0);
  scene.feel(12);
  EXPECT_EQ(scene.site->neighbourCount(), 0);
}

/// A hand that has rested until its site does nothing any more.
struct RestingHand : TouchingHand {
  explicit RestingHand(bool shares) {
    if (shares) {
      btRigidBody& far = rig.addCube(0.2, kHalf, Vec3(5.0, 0, 0));
      attach().share(far);
    }
    body = &rig.addCube(0.3, kHalf, Vec3(0, 0, 2.0));
    feel(480);
    const std::uint64_t skipped = site->counters().host_steps_skipped;
    feel(1);
    EXPECT_EQ(site->counters().host_steps_skipped, skipped + 1) << "not quiet";
  }
  btRigidBody* body;
};

class BodyAtARestingHand : public ::testing::TestWithParam<bool> {};

TEST_P(BodyAtARestingHand, IsFeltWhenTheHostPutsItThere) {
  RestingHand hand(GetParam());
  hand.body->setWorldTransform(toBullet(TouchingHand::beside(), Quat::Identity()));
  hand.body->setInterpolationWorldTransform(hand.body->getWorldTransform());
  EXPECT_GT(hand.feel(12), kFelt);
}

TEST_P(BodyAtARestingHand, IsFeltWhenItFliesThere) {
  RestingHand hand(GetParam());
  hand.body->activate(true);
  hand.body->setLinearVelocity(btVector3(0, 0, -2));
  EXPECT_GT(hand.feel(300), kFelt);
}

TEST_P(BodyAtARestingHand, IsFeltWhenTheHostMovesItKinematically) {
  RestingHand hand(GetParam());
  hand.refilter(*hand.body, 1, 0);  // out of the way
  btRigidBody& pusher = hand.rig.addCube(0.0, TouchingHand::kHalf, Vec3(0.5, 0, 0));
  hand.rig.world.removeRigidBody(&pusher);
  pusher.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  pusher.setActivationState(DISABLE_DEACTIVATION);
  hand.rig.world.addRigidBody(&pusher);
  hand.feel(60);
  double most = 0.0;
  for (int i = 0; i < 240; ++i) {
    const double x = std::max(TouchingHand::beside().x(), 0.5 - 0.004 * i);
    pusher.setWorldTransform(toBullet(Vec3(x, 0, 0), Quat::Identity()));
    most = std::max(most, hand.feel(1));
  }
  EXPECT_GT(most, kFelt);
}

INSTANTIATE_TEST_SUITE_P(Sites, BodyAtARestingHand, ::testing::Bool(),
                         [](const auto& shares) { return shares.param ? "WithAShare" : "Alone"; });

}  // namespace
}  // namespace tandem
