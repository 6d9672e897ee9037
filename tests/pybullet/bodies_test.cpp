// PyBullet's bodies while a site has them, and after.

#include "plugin_rig.h"

namespace tandem::test {
namespace {

StubBody makeBrick() {
  StubBody brick;
  brick.mass = 0.6;
  brick.inertia = Vec3(5e-5, 2.6e-4, 2.9e-4) * 2.0;
  brick.shape = {makeStubShape(b3::kBox, Vec3(0.1, 0.04, 0.02))};
  return brick;
}

TEST(NothingRegistered, AsksTheServerNothing) {
  PluginHost host;
  host.engine.add(makeStubCube());
  host.step(10);
  EXPECT_EQ(host.engine.commands, 0);
}

TEST(SharedBody, CarriesItsShareUntilClose) {
  StubBody before = makeBrick();
  before.is_multibody = false;
  PluginHost host;
  const int brick = host.engine.add(before), floor = host.engine.add(makeStubFloor());
  host.command(kFarHand);
  host.command("site peers=3");
  host.command("share body=" + std::to_string(brick) + " shape=box size=0.05,0.02,0.01");
  host.command("obstacle body=" + std::to_string(floor));
  const StubBody& body = host.engine.bodies.at(brick);
  EXPECT_DOUBLE_EQ(body.mass, 0.2);
  EXPECT_LT((body.inertia - before.inertia / 3.0).norm(), 1e-18);
  EXPECT_LT(body.linear_damping, 1e-29);
  EXPECT_FALSE(body.may_sleep);
  EXPECT_EQ(host.engine.without_contact.size(), 1u);
  host.step(3);
  host.command("close");
  EXPECT_EQ(body.mass, before.mass);
  EXPECT_EQ(body.inertia, before.inertia);
  EXPECT_EQ(body.linear_damping, 0.04);
  EXPECT_EQ(body.angular_damping, 0.04);
  EXPECT_TRUE(body.may_sleep);
  EXPECT_EQ(host.engine.bodies.at(floor).linear_damping, 0.04);
  EXPECT_TRUE(host.engine.without_contact.empty());
  host.command(kFarHand);
  host.command("site");  // a site can be opened again
}

TEST(SharedBody, TakesTheMomentumOfANativeHit) {
  SharedCube shared;
  shared.body().hit = Vec3(0.03, 0.0, 0.04);
  shared.host.step(3);
  EXPECT_LT((shared.body().state.v_W - Vec3(0.3, 0.0, 0.4)).norm(), 1e-12);
  EXPECT_LT((Vec3(&shared.host.read()[kObjects + 7]) - Vec3(0.3, 0.0, 0.4)).norm(), 1e-12);
}

TEST(SharedBody, FeelsWhatTheUserDoesToIt) {
  SharedCube shared;
  shared.host.step();
  shared.body().state.p_W = Vec3(1.0, 2.0, 3.0);
  shared.body().state.v_W = Vec3(0.0, 0.5, 0.0);
  shared.host.step(24);
  // The body continues from its new place at its new velocity, from the end of the island's tick.
  const Vec3 expected(1.0, 2.05, 3.0);
  EXPECT_LT((shared.body().state.p_W - expected).norm(), 0.5 * 1e-3);
  EXPECT_LT((shared.body().state.v_W - Vec3(0.0, 0.5, 0.0)).norm(), 1e-12);
}

// The body falls with gravity once, not twice; also when gravity changes on the way.
TEST(SharedBody, FallsAsTheServersGravitySays) {
  SharedCube shared;
  for (const double g : {-9.81, 4.0}) {
    shared.host.engine.gravity = Vec3(0, 0, g);
    const double before = shared.body().state.v_W.z();
    shared.host.step(24);
    EXPECT_NEAR(shared.body().state.v_W.z() - before, 0.1 * g, 1e-3 * std::abs(g)) << g;
  }
}

class Turning : public ::testing::TestWithParam<double> {};

// A brick tumbles as a free body: the server's own gyroscopic term is neither lost nor counted
// twice.
TEST_P(Turning, KeepsItsAngularMomentum) {
  StubBody brick = makeBrick();
  brick.state.w_W = Vec3(1.0, 6.0, 0.5);
  SharedCube shared(brick);
  shared.host.engine.time_step = 1.0 / GetParam();
  const auto momentum = [&] {
    const RigidState& s = shared.body().state;
    return Vec3(s.q_WB * Vec3(shared.body().inertia.cwiseProduct(s.q_WB.conjugate() * s.w_W)));
  };
  const Vec3 before = momentum();
  shared.host.step(static_cast<int>(GetParam()));
  EXPECT_LT((momentum() - before).norm(), 1e-6 * before.norm());
  const Quat island(Eigen::Map<const Eigen::Vector4d>(&shared.host.read()[kObjects + 3]));
  EXPECT_LT(island.angularDistance(shared.body().state.q_WB), 1e-9);
}
INSTANTIATE_TEST_SUITE_P(Rates, Turning, ::testing::Values(60.0, 240.0, 1000.0));

// A step turns it by more than a radian: PyBullet's gyroscopic term cannot be made up for.
TEST(SharedBody, KeepsItsAngularMomentumWhenItSpinsFast) {
  StubBody brick = makeBrick();
  brick.state.w_W = Vec3(30.0, 60.0, 40.0);
  SharedCube shared(brick);
  shared.host.engine.time_step = 1.0 / 50.0;
  const auto momentum = [&] {
    const RigidState& s = shared.body().state;
    return Vec3(s.q_WB * Vec3(shared.body().inertia.cwiseProduct(s.q_WB.conjugate() * s.w_W)));
  };
  const Vec3 before = momentum();
  shared.host.step(50);
  EXPECT_LT((momentum() - before).norm(), 1e-6 * before.norm());
  EXPECT_EQ(shared.host.read()[kHasEnded], 0.0) << shared.host.warnings();
}

TEST(Obstacle, CarriesAPress) {
  Pressed pressed;
  pressed.host.command("obstacle body=" + std::to_string(pressed.floor));
  const auto height = [&] { return pressed.host.engine.bodies.at(pressed.cube).state.p_W.z(); };
  pressed.host.step(60);
  const double before = height();
  EXPECT_NEAR(before, 0.02, 2e-4);  // falls for one step until the floor is known: g (5 ms)^2 / 2
  pressed.host.command("hand force=0,0,-5");
  pressed.host.step(240);
  EXPECT_NEAR(pressed.host.read()[2], 5.0, 1e-3);
  EXPECT_GT(height(), before - 1e-6);
}

TEST(Obstacle, IsFollowedWhereItIsMoved) {
  Pressed pressed;
  pressed.host.command("obstacle body=" + std::to_string(pressed.floor));
  pressed.host.step(10);
  pressed.host.engine.bodies.at(pressed.floor).state.p_W.z() = -0.1;
  pressed.host.step(240);
  EXPECT_NEAR(pressed.host.engine.bodies.at(pressed.cube).state.p_W.z(), -0.08, 1e-4);
}

TEST(Obstacle, MayBeOfSeveralPiecesOffItsCentre) {
  StubBody table;
  table.mass = 0.0;
  for (const double x : {-0.5, 0.5}) {
    b3::CollisionShapeData piece = makeStubShape(b3::kBox, Vec3(1.0, 1.0, 0.1));
    piece.frame[0] = x;
    piece.frame[2] = -0.05;
    table.shape.push_back(piece);
  }
  Pressed pressed;
  const int number = pressed.host.engine.add(table);
  pressed.host.command("obstacle body=" + std::to_string(number));
  pressed.host.step(120);
  EXPECT_NEAR(pressed.host.engine.bodies.at(pressed.cube).state.p_W.z(), 0.02, 2e-4);
}

// A table of two legs stands on the floor; the hand presses its plate, whose middle is free.
TEST(SharedBody, MayBeOfSeveralPiecesOffItsCentre) {
  StubBody table = makeStubCube();
  table.shape.clear();
  const auto add = [&](const Vec3& size, const Vec3& at) {
    b3::CollisionShapeData piece = makeStubShape(b3::kBox, size);
    for (int i = 0; i < 3; ++i) piece.frame[i] = at[i];
    table.shape.push_back(piece);
  };
  add({0.2, 0.1, 0.02}, {0.0, 0.0, 0.03});
  for (const double x : {-0.09, 0.09}) add({0.02, 0.1, 0.06}, {x, 0.0, -0.01});
  table.state.p_W = Vec3(0.0, 0.5, 0.04);
  Pressed pressed;
  const int number = pressed.host.engine.add(table);
  pressed.host.command("share body=" + std::to_string(number));
  pressed.host.command("obstacle body=" + std::to_string(pressed.floor));
  pressed.host.step(120);
  EXPECT_NEAR(pressed.host.engine.bodies.at(number).state.p_W.z(), 0.04, 3e-4);
  EXPECT_NEAR(pressed.host.engine.bodies.at(number).state.p_W.y(), 0.5, 1e-4);
}

// Guests of Tandem's world touch only there, in any order of joining.
TEST(NativeContact, IsStoppedBetweenAllThatTandemHas) {
  for (const bool connects_first : {true, false}) {
    PluginHost host;
    StubEngine& engine = host.engine;
    for (const StubBody& body : {makeStubCube(), makeStubCube(), makeStubFloor()}) engine.add(body);
    const int sphere = engine.add(makeStubCube());
    const int other = engine.add(makeStubCube());
    host.command(kFarHand);
    host.command("site");
    host.command("link kind=manual");
    const auto connect = [&] {
      host.command("connect peer=2 link=0 start=0,0,1");
      host.command("proxy remote=0 body=" + std::to_string(sphere));
    };
    if (connects_first) connect();
    for (const char* command : {"share body=0", "obstacle body=2", "share body=1"}) {
      host.command(command);
    }
    if (!connects_first) connect();
    EXPECT_EQ(engine.without_contact.size(), 6u) << connects_first;  // all pairs of four
    for (const auto& [a, b] : engine.without_contact) {
      EXPECT_FALSE(a == other || b == other) << connects_first;
    }
    host.command("close");
    EXPECT_TRUE(engine.without_contact.empty()) << connects_first;
  }
}

TEST(WrongTimeStep, IsNoticed) {
  SharedCube shared;
  shared.body().state.v_W.x() = 0.1;
  shared.host.engine.moves_for = 1.0 / 120.0;
  shared.host.step(2);
  EXPECT_NE(shared.host.warnings().find("PyBullet moved a body for 0.008333 s"), std::string::npos)
      << shared.host.warnings();
}

TEST(DeformableWorld, EndsTheSiteWithTheRemedy) {
  SharedCube shared;
  shared.body().state.v_W.x() = 0.1;
  shared.host.engine.is_deformable = true;
  shared.host.step(3);
  EXPECT_EQ(shared.host.read()[kHasEnded], 1.0);
  const std::string said = shared.host.warnings();
  EXPECT_NE(said.find("PyBullet's world is deformable"), std::string::npos) << said;
  EXPECT_NE(said.find("without RESET_USE_DEFORMABLE_WORLD: the site has ended"), std::string::npos)
      << said;
  EXPECT_EQ(said.find("0.000000 s"), std::string::npos) << said;
}

// Its velocity is kept, but nothing moves it. Another reason is no deformable world.
TEST(HeldBody, IsNamed) {
  SharedCube shared;
  shared.body().state.v_W.x() = 0.1;
  shared.host.engine.moves_for = 1e-12;
  shared.host.step(3);
  EXPECT_EQ(shared.host.read()[kHasEnded], 0.0);
  const std::string said = shared.host.warnings();
  EXPECT_NE(said.find("body 0 has a velocity, but PyBullet did not move it"), std::string::npos)
      << said;
  EXPECT_EQ(said.find("0.000000 s"), std::string::npos) << said;
}

}  // namespace
}  // namespace tandem::test
