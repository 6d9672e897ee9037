// Compounds that move: the hand and proxies feel them as they feel standing ones, part by part, and
// sites share them.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btEmptyShape.h>

#include "tandem/coordination/simulated_link.h"
#include "tandem/plugin/site.h"

#include "physics/hand_scene.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;
using test::HandScene;
using test::Role;

constexpr double kRate = test::HandScene::kRate;            // of the host [Hz]
constexpr double kStiffness = test::HandScene::kStiffness;  // of contact [N/m]
constexpr std::uint64_t kSeed = 20260303;

btCompoundShape& makeCompoundOf(BulletRig& rig,
                                const std::vector<std::pair<btCollisionShape*, btTransform>>& all) {
  auto& compound = rig.makeShape<btCompoundShape>();
  for (const auto& [child, pose] : all) compound.addChildShape(pose, child);
  return compound;
}

btBoxShape& makeBox(BulletRig& rig, const Vec3& half) {
  return rig.makeShape<btBoxShape>(toBullet(half));
}

btTransform at(const Vec3& p, const Quat& q = Quat::Identity()) { return toBullet(p, q); }

/// Two boxes of an L, the second in a compound of its own, as URDF's links have them.
btCompoundShape& makeL(BulletRig& rig) {
  auto& upright = makeCompoundOf(rig, {{&makeBox(rig, {0.01, 0.05, 0.03}), at({0.0, 0.06, 0.0})}});
  return makeCompoundOf(rig, {{&makeBox(rig, {0.1, 0.01, 0.03}), at({0.0, 0.0, 0.0})},
                              {&upright, at({-0.09, 0.0, 0.0})}});
}

TEST(MovingCompound, TheHandFeelsEachArmOfAnL) {
  for (const Role role : {Role::kStanding, Role::kKinematic, Role::kNeighbour, Role::kShared}) {
    SCOPED_TRACE(static_cast<int>(role));
    HandScene scene({0.05, 0.05, 0.0});
    scene.start(makeL(scene.rig), role);
    const double rounding = byWidth(1e-5, 5e-3);
    EXPECT_LT((scene.press({0.05, 0.018, 0.0}) - Vec3(0.0, 4.0, 0.0)).norm(), rounding);
    EXPECT_LT(scene.press({0.05, 0.07, 0.0}).norm(), 1e-9);
    EXPECT_LT((scene.press({-0.073, 0.07, 0.0}) - Vec3(6.0, 0.0, 0.0)).norm(), rounding);
    // In the inner corner both arms push.
    EXPECT_LT((scene.press({-0.072, 0.019, 0.0}) - Vec3(4.0, 2.0, 0.0)).norm(), rounding);
  }
}

/// Shapes of many kinds, in compounds and alone.
btCollisionShape& drawCompound(BulletRig& rig, test::Random& random,
                               std::vector<std::unique_ptr<btTriangleMesh>>& meshes) {
  std::vector<std::pair<btCollisionShape*, btTransform>> children;
  const auto add = [&](btCollisionShape& shape) {
    children.emplace_back(&shape, at(random.inCube(0.03), random.rotation()));
  };
  const auto scalar = [](double x) { return static_cast<btScalar>(x); };
  add(makeBox(rig, {0.03, 0.02, 0.01}));
  if (random.below(2)) add(rig.makeShape<btCapsuleShapeX>(scalar(0.01), scalar(0.04)));
  if (random.below(2))
    add(rig.makeShape<btCylinderShapeZ>(btVector3(scalar(0.02), scalar(0.02), scalar(0.01))));
  if (random.below(2)) {
    auto& cone = rig.makeShape<btConeShape>(scalar(0.02), scalar(0.04));
    cone.setMargin(scalar(0.001));
    add(cone);
  }
  if (random.below(2)) {
    auto& hull = rig.makeShape<btConvexHullShape>();
    for (int i = 0; i < 12; ++i) hull.addPoint(toBullet(Vec3(0.03 * random.direction())));
    hull.setMargin(scalar(0.001));
    add(hull);
  }
  if (random.below(2)) {
    const btVector3 centres[] = {btVector3(0, 0, 0), btVector3(scalar(0.02), 0, 0)};
    const btScalar radii[] = {scalar(0.01), scalar(0.015)};
    auto& spheres = rig.makeShape<btMultiSphereShape>(centres, radii, 2);
    spheres.setMargin(scalar(0.005));
    add(spheres);
  }
  if (random.below(3) == 0) {
    meshes.push_back(std::make_unique<btTriangleMesh>());
    const Vec3 corner[] = {{0, 0, 0}, {0.03, 0, 0}, {0, 0.03, 0}, {0, 0, 0.03}};
    for (const auto& [a, b, c] : {std::tuple(0, 2, 1), {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
      meshes.back()->addTriangle(toBullet(corner[a]), toBullet(corner[b]), toBullet(corner[c]));
    auto& mesh = rig.makeShape<btBvhTriangleMeshShape>(meshes.back().get(), true);
    mesh.setMargin(scalar(0.001));
    add(mesh);
  }
  add(rig.makeShape<btEmptyShape>());  // hosts' place holders
  return makeCompoundOf(rig, children);
}

// The same forces on the same way of the hand, whether Bullet's compound stands or is too heavy to
// be moved.
TEST(MovingCompound, PushesAsAStandingOneDoes) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  int pressed = 0;
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE("compound " + std::to_string(i));
    std::vector<std::vector<Vec3>> forces;
    for (const Role role : {Role::kStanding, Role::kKinematic, Role::kNeighbour, Role::kShared}) {
      test::Random random(kSeed + static_cast<std::uint64_t>(i));
      std::vector<std::unique_ptr<btTriangleMesh>> meshes;
      HandScene scene(0.15 * random.direction());
      scene.start(drawCompound(scene.rig, random, meshes), role);
      std::vector<Vec3>& found = forces.emplace_back();
      for (int k = 0; k < 4; ++k) found.push_back(scene.press(random.inCube(0.04)));
      scene.site.reset();
    }
    for (std::size_t k = 0; k < forces[0].size(); ++k) {
      pressed += forces[0][k].norm() > 1.0;
      for (std::size_t role = 1; role < forces.size(); ++role)
        EXPECT_LT((forces[role][k] - forces[0][k]).norm(),
                  byWidth(1e-6, 1e-2) * (1.0 + forces[0][k].norm()))
            << "place " << k << ", role " << role;
    }
  }
  EXPECT_GT(pressed, 20);
}

/// Two sites with a copy of one body each, over a link with delay. The hand of the first pushes.
struct TwoSites {
  BulletRig rigs[2];
  test::FakeDevice devices[2] = {test::FakeDevice({-0.1, 0.01, 0.005}),
                                 test::FakeDevice({0.0, 0.3, 0.0})};
  std::unique_ptr<SimulatedLink> links[2];
  std::unique_ptr<Site> sites[2];
  btRigidBody* bodies[2] = {};

  /// `is_compound`: the box of 6 x 4 x 4 cm in a compound with a ball in its middle, which nothing
  /// reaches. Else alone.
  TwoSites(bool is_compound, double delay, const CouplerGains& coordination) {
    Impairments impairments;
    impairments.delay = delay;
    std::tie(links[0], links[1]) = makeSimulatedLinks(impairments);
    for (int i = 0; i < 2; ++i) {
      BulletRig& rig = rigs[i];
      btBoxShape& box = makeBox(rig, {0.03, 0.02, 0.02});
      btCollisionShape& shape =
          is_compound
              ? makeCompoundOf(
                    rig, {{&box, at(Vec3::Zero())},
                          {&rig.makeShape<btSphereShape>(btScalar(0.002)), at({0.001, 0.0, 0.0})}})
              : static_cast<btCollisionShape&>(box);
      bodies[i] = &rig.addBody(shape, 0.2);
      btVector3 inertia;
      box.calculateLocalInertia(btScalar(0.2), inertia);
      bodies[i]->setMassProps(btScalar(0.2), inertia);
      bodies[i]->updateInertiaTensor();
      SiteSettings settings;
      settings.self = PeerId{static_cast<std::uint32_t>(i) + 1};
      settings.contact = {kStiffness, 1.0};
      settings.coordination = coordination;
      settings.proxy.damping = 0.0;
      sites[i] = std::make_unique<Site>(settings, rig.world, devices[i]);
      sites[i]->share(*bodies[i]);
      sites[i]->connect(PeerId{static_cast<std::uint32_t>(2 - i)}, *links[i],
                        devices[1 - i].sample.hip.p_W);
    }
  }
  ~TwoSites() {
    for (auto& site : sites) site.reset();
  }

  void step() {
    for (BulletRig& rig : rigs) rig.step(1.0 / kRate);
  }
  [[nodiscard]] Vec3 velocity(int i) const { return fromBullet(bodies[i]->getLinearVelocity()); }
  [[nodiscard]] Vec3 spin(int i) const { return fromBullet(bodies[i]->getAngularVelocity()); }
  [[nodiscard]] Vec3 place(int i) const { return fromBullet(bodies[i]->getCenterOfMassPosition()); }
};

// Hand and proxy push the two copies. A compound that touches with a box only moves as that box.
TEST(SharedCompound, MovesOverALinkAsItsOnlyReachablePart) {
  std::vector<Vec3> ways[2];
  for (const bool is_compound : {false, true}) {
    TwoSites two(is_compound, 0.01, {200.0, 30.0});
    const Vec3 start = two.devices[0].sample.hip.p_W;
    double strongest = 0.0;
    for (int i = 0; i < 240; ++i) {
      two.devices[0].sample.hip = {start + Vec3(0.1 * i / kRate, 0.0, 0.0), Vec3(0.1, 0.0, 0.0)};
      two.step();
      strongest = std::max(strongest, two.devices[0].force_W.norm());
      for (int site : {0, 1}) {
        ways[is_compound].push_back(two.place(site));
        ways[is_compound].push_back(two.spin(site));
      }
    }
    EXPECT_GT(strongest, 0.5);
    EXPECT_GT(two.place(0).x(), 0.01);
    EXPECT_GT(two.place(1).x(), 0.01);
    EXPECT_GT(two.spin(1).norm(), 0.01) << "the hand pushes beside the middle";
  }
  for (std::size_t i = 0; i < ways[0].size(); ++i)
    EXPECT_LT((ways[0][i] - ways[1][i]).norm(), byWidth(1e-7, 1e-3)) << i;
}

// A copy hits the proxy of the other site's user. Without couplers the two are alone.
TEST(SharedCompound, KeepsMomentumWithTheProxyOfAPeer) {
  TwoSites two(true, 0.01, {0.0, 0.0});
  for (int i = 0; i < 48; ++i) two.step();  // packets arrive
  const btRigidBody& proxy = *two.sites[1]->proxyBody(0);
  two.bodies[1]->activate(true);
  two.bodies[1]->setLinearVelocity(btVector3(btScalar(-0.4), 0, 0));
  const auto momentum = [&] {
    return Vec3(0.1 * two.velocity(1) +
                fromBullet(proxy.getLinearVelocity()) / static_cast<double>(proxy.getInvMass()));
  };
  const Vec3 before = momentum();
  for (int i = 0; i < 120; ++i) two.step();
  EXPECT_GT(two.velocity(1).x(), -0.39) << "it has met the proxy";
  EXPECT_GT(two.spin(1).norm(), 0.01);
  EXPECT_LT((momentum() - before).norm(), byWidth(1e-9, 1e-5) * before.norm());
}

// The host moves one child of a shared compound: the hand feels it where it is now.
TEST(SharedCompound, FollowsWhatTheHostDoesToItsChildren) {
  for (const Role role : {Role::kNeighbour, Role::kShared, Role::kKinematic}) {
    SCOPED_TRACE(static_cast<int>(role));
    HandScene scene({0.0, 0.1, 0.0});
    btCompoundShape& compound =
        makeCompoundOf(scene.rig, {{&makeBox(scene.rig, {0.02, 0.02, 0.02}), at(Vec3::Zero())},
                                   {&makeBox(scene.rig, {0.02, 0.02, 0.02}), at({0.3, 0.0, 0.0})}});
    scene.start(compound, role);
    EXPECT_LT((scene.press({0.0, 0.029, 0.0}) - Vec3(0.0, 2.0, 0.0)).norm(), byWidth(1e-5, 5e-3));
    scene.press({0.0, 0.1, 0.0});
    compound.updateChildTransform(0, at({0.0, 0.01, 0.0}));
    scene.run(0.1);
    EXPECT_LT((scene.press({0.0, 0.039, 0.0}) - Vec3(0.0, 2.0, 0.0)).norm(), byWidth(1e-5, 5e-3));
    scene.press({0.0, 0.1, 0.0});
    compound.removeChildShapeByIndex(0);
    scene.run(0.1);
    EXPECT_LT(scene.press({0.0, 0.039, 0.0}).norm(), 1e-9);
  }
}

/// A hand that moves along x at 0.1 m/s from the start on.
class MovingHand final : public HapticDevice {
 public:
  static constexpr double kSpeed = 0.1;  // [m/s]
  explicit MovingHand(const Vec3& start_W) : start_W_(start_W) {}
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override { return limits_; }
  [[nodiscard]] DeviceSample read(double now) noexcept override {
    return {{start_W_ + Vec3(kSpeed * now, 0.0, 0.0), Vec3(kSpeed, 0.0, 0.0)}, true};
  }
  void write(const Vec3& f_W) noexcept override {
    sum_W += f_W;
    ++count;
  }

  Vec3 sum_W = Vec3::Zero();
  int count = 0;

 private:
  DeviceCapabilities limits_{"moving hand"};
  Vec3 start_W_;
};

// A compound that has weight stands on a floor, and is pushed over it.
TEST(SharedCompound, StandsOnAFloorAndIsPushed) {
  BulletRig rig(Vec3(0.0, 0.0, -9.81));
  rig.addBody(rig.makeShape<btBoxShape>(btVector3(2, 2, btScalar(0.1))), 0.0, Vec3(0.0, 0.0, -0.1));
  btRigidBody& body =
      rig.addBody(makeCompoundOf(rig, {{&makeBox(rig, {0.02, 0.02, 0.02}), at({-0.02, 0.0, 0.0})},
                                       {&makeBox(rig, {0.02, 0.02, 0.02}), at({0.02, 0.0, 0.0})}}),
                  0.2, Vec3(0.0, 0.0, 0.02));
  MovingHand device(Vec3(-0.08, 0.0, 0.015));
  SiteSettings settings;
  settings.peers = 1;
  settings.contact = {kStiffness, 5.0};
  Site site(settings, rig.world, device);
  site.share(body);
  const auto place = [&] { return fromBullet(body.getCenterOfMassPosition()); };
  const auto run = [&](double duration) {
    for (int i = 0; i < duration * kRate; ++i) rig.step(1.0 / kRate);
  };
  run(0.1);
  EXPECT_NEAR(place().z(), 0.02, 2e-4);
  run(0.9);
  device.sum_W.setZero(), device.count = 0;
  run(0.5);
  EXPECT_NEAR(place().z(), 0.02, 2e-4);
  EXPECT_NEAR(place().x(), -0.08 + 0.01 + 0.04 + 0.15, 2e-3);
  EXPECT_NEAR(device.sum_W.x() / device.count, -0.25 * 0.2 * 9.81, 0.01);  // 0.5 on each
}

TEST(SharedCompound, RefusesPartsThatNobodyCanFeel) {
  BulletRig rig;
  test::FakeDevice device;
  Site site(SiteSettings{}, rig.world, device);
  const auto refusal = [&](btCollisionShape& shape) -> std::string {
    try {
      site.share(rig.addBody(shape, 0.1));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  btBoxShape& box = makeBox(rig, Vec3::Constant(0.02));
  auto& plane = rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0));
  EXPECT_NE(refusal(rig.makeShape<btCompoundShape>()).find("a Compound of nothing"),
            std::string::npos);
  EXPECT_NE(refusal(makeCompoundOf(rig, {{&box, at(Vec3::Zero())}, {&plane, at(Vec3::Zero())}}))
                .find("not a Compound with a STATICPLANE"),
            std::string::npos);
}

}  // namespace
}  // namespace tandem
