// A body deleted and another made at its address is another body, with every broadphase of Bullet.

#include <array>
#include <cstddef>
#include <memory>
#include <new>

#include <gtest/gtest.h>

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>
#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem {
namespace {

constexpr double kMass = 0.2, kHalf = 0.02, kDt = 1.0 / 60.0, kGravity = 9.81;
/// A new body falls as far in its first step, in which Bullet finds no contact of boxes that just
/// touch [m].
constexpr double kFall = kGravity * kDt * kDt;

enum class Kind { kDbvt, kAxisSweep, kAxisSweep32, kSimple };

std::unique_ptr<btBroadphaseInterface> makeBroadphase(Kind kind) {
  const btVector3 low(-10, -10, -10), high(10, 10, 10);
  switch (kind) {
    case Kind::kAxisSweep:
      return std::make_unique<btAxisSweep3>(low, high);
    case Kind::kAxisSweep32:
      return std::make_unique<bt32BitAxisSweep3>(low, high);
    case Kind::kSimple:
      return std::make_unique<btSimpleBroadphase>();
    default:
      return std::make_unique<btDbvtBroadphase>();
  }
}

/// A cube at a fixed place in memory.
class CubeInPlace {
 public:
  CubeInPlace(btCollisionShape& shape, double x) : shape_(shape), x_(x) { make(); }
  ~CubeInPlace() { body().~btRigidBody(); }
  CubeInPlace(const CubeInPlace&) = delete;
  CubeInPlace& operator=(const CubeInPlace&) = delete;

  [[nodiscard]] btRigidBody& body() { return *made_; }
  void makeAnew(btDiscreteDynamicsWorld& world) {
    world.removeRigidBody(&body());
    body().~btRigidBody();
    make();
    world.addRigidBody(&body());
  }

 private:
  void make() {
    btVector3 inertia;
    shape_.calculateLocalInertia(static_cast<btScalar>(kMass), inertia);
    made_ =
        new (memory_.data()) btRigidBody(static_cast<btScalar>(kMass), nullptr, &shape_, inertia);
    made_->setWorldTransform(toBullet(Vec3(x_, 0.0, kHalf), Quat::Identity()));
  }

  btCollisionShape& shape_;
  double x_;
  alignas(btRigidBody) std::array<std::byte, sizeof(btRigidBody)> memory_;
  btRigidBody* made_ = nullptr;
};

struct Scene {
  explicit Scene(Kind kind) : broadphase(makeBroadphase(kind)) {
    world.setGravity(btVector3(0, 0, static_cast<btScalar>(-kGravity)));
    floor.setWorldTransform(toBullet(Vec3(0.0, 0.0, -0.1), Quat::Identity()));
    world.addRigidBody(&floor);
    world.addRigidBody(&cube.body());
    world.addRigidBody(&box.body());
    SiteSettings settings;
    settings.peers = 1;
    site = std::make_unique<Site>(settings, world, device);
    (void)site->share(cube.body());
    run(0.3);
  }
  ~Scene() {
    site.reset();
    for (btRigidBody* body : {&floor, &cube.body(), &box.body()}) world.removeRigidBody(body);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void run(double seconds) {
    for (double t = 0.0; t < seconds - 0.5 * kDt; t += kDt)
      world.stepSimulation(static_cast<btScalar>(kDt), 0);
  }
  void expectAllStand() {
    for (btRigidBody* body : {&cube.body(), &box.body()})
      EXPECT_NEAR(static_cast<double>(body->getWorldTransform().getOrigin().z()), kHalf, kFall);
    EXPECT_TRUE(site->isHeld(0));
    EXPECT_EQ(site->status(), kTickOk);
  }

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  std::unique_ptr<btBroadphaseInterface> broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, broadphase.get(), &solver, &configuration};
  btBoxShape slab{btVector3(1, 1, btScalar(0.1))};
  btBoxShape shape{btVector3(1, 1, 1) * static_cast<btScalar>(kHalf)};
  btRigidBody floor{0, nullptr, &slab};
  CubeInPlace cube{shape, 0.0}, box{shape, 0.045};
  test::FakeDevice device{Vec3(0.0, 0.0, 0.5)};
  std::unique_ptr<Site> site;
};

class BodyIdentity : public ::testing::TestWithParam<Kind> {};

TEST_P(BodyIdentity, ASharedBodyMadeAnewAtItsAddressIsAnother) {
  Scene scene(GetParam());
  ASSERT_EQ(scene.site->counters().objects_left, 0u);
  scene.cube.makeAnew(scene.world);
  scene.run(0.3);
  EXPECT_EQ(scene.site->counters().objects_left, 1u);
  scene.expectAllStand();
}

TEST_P(BodyIdentity, ANeighbourMadeAnewAtItsAddressIsAnother) {
  Scene scene(GetParam());
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  const std::uint64_t promoted = scene.site->counters().promoted;
  scene.box.makeAnew(scene.world);
  scene.run(0.3);
  EXPECT_EQ(scene.site->counters().promoted, promoted + 1);
  scene.expectAllStand();
}

// At rest, only the watch over sleepers looks.
TEST_P(BodyIdentity, AParkedBodyMadeAnewAtItsAddressIsAnother) {
  Scene scene(GetParam());
  scene.run(3.0);
  ASSERT_GT(scene.site->counters().host_steps_skipped, 0u);
  scene.cube.makeAnew(scene.world);
  scene.cube.body().forceActivationState(ISLAND_SLEEPING);
  scene.run(0.3);
  EXPECT_EQ(scene.site->counters().objects_left, 1u);
  scene.expectAllStand();
}

INSTANTIATE_TEST_SUITE_P(Broadphases, BodyIdentity,
                         ::testing::Values(Kind::kDbvt, Kind::kAxisSweep, Kind::kAxisSweep32,
                                           Kind::kSimple));

}  // namespace
}  // namespace tandem
