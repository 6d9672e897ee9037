// A host with its own engine, whose bodies have guests in a world of Tandem's.

#include <algorithm>

#include "c_door/c_door_rig.h"
#include "support/random.h"

namespace tandem {
namespace {

using namespace test;

constexpr double kStep = 1.0 / 240.0;
constexpr double kMass = 0.1;  // mass of the cube's copy: half of 0.2 kg

/// One shared cube, and the host's body that it represents.
struct Guest : FreeDoorCube {
  TandemState now{};

  Guest() : FreeDoorCube(makeWorld()) { now = body(cube); }

  /// The engine turns and moves bodies by their velocities; `meanwhile` may change them.
  template <typename Meanwhile>
  void step(Meanwhile meanwhile) {
    TandemState given{};
    ok(tandem_world_begin_step(world, kStep, nullptr, 1, &cube, &now, &given));
    now = given;
    meanwhile();
    for (int i = 0; i < 3; ++i) now.position[i] += kStep * now.velocity[i];
    const Vec3 turn = kStep * toVec3(now.angular_velocity);
    const Quat before(now.orientation[3], now.orientation[0], now.orientation[1],
                      now.orientation[2]);
    const double angle = turn.norm();
    const Quat turned =
        angle > 0.0 ? Quat(Eigen::AngleAxisd(angle, turn / angle)) * before : before;
    std::copy_n(turned.coeffs().data(), 4, now.orientation);
    ok(tandem_world_end_step(world, 1, &cube, &now, &now));
  }
  void step() {
    step([] {});
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  [[nodiscard]] double islandSpeed() const { return object().velocity[0]; }
};

TEST(Guest, StandsWhereItIs) {
  Guest guest;
  guest.steps(20);  // it falls asleep in Tandem's world
  EXPECT_EQ(toVec3(guest.now.position), Vec3::Zero());
  EXPECT_EQ(toVec3(guest.now.velocity), Vec3::Zero());
}

// J = 0.02 N s on 0.1 kg, also on a sleeping body.
TEST(Guest, TakesTheHostsImpulse) {
  for (const int rest : {0, 1, 20}) {
    Guest guest;
    guest.steps(rest);
    guest.now.velocity[0] += 0.02 / kMass;
    guest.steps(2);
    EXPECT_NEAR(guest.islandSpeed(), 0.2, byDoorWidth(1e-12, 1e-7)) << rest;
    EXPECT_NEAR(guest.now.velocity[0], 0.2, byDoorWidth(1e-12, 1e-7)) << rest;
    // The island is ahead of the host by up to a tick when it learns of the impulse.
    const double late = rest == 0 ? byDoorWidth(1e-12, 1e-9) : 0.2 * 1e-3;
    EXPECT_NEAR(guest.now.position[0], 2 * kStep * 0.2, late) << rest;
  }
}

TEST(Guest, GoesAlongWhenTheHostMovesIt) {
  for (const int rest : {0, 1, 20}) {
    Guest guest;
    guest.now.velocity[0] = 0.2;
    guest.steps(rest);
    guest.now.position[1] = 0.5;
    const double angle = 0.3;
    guest.now.orientation[2] = std::sin(0.5 * angle),
    guest.now.orientation[3] = std::cos(0.5 * angle);
    guest.steps(3);
    const TandemState object = guest.object();
    EXPECT_NEAR(object.position[1], 0.5, byDoorWidth(1e-12, 1e-7)) << rest;
    EXPECT_NEAR(object.orientation[2], std::sin(0.5 * angle), byDoorWidth(1e-12, 1e-6)) << rest;
    EXPECT_NEAR(object.velocity[0], 0.2, byDoorWidth(1e-12, 1e-7)) << rest;
    EXPECT_NEAR(guest.now.position[1], 0.5, byDoorWidth(1e-12, 1e-7)) << rest;
  }
}

// A rotation at 2 rad/s for 0.1 s is 0.2 rad.
TEST(Guest, TurnsAsTheIslandHasIt) {
  Guest guest;
  guest.now.angular_velocity[2] = 2.0;
  guest.steps(24);
  EXPECT_NEAR(2.0 * std::asin(guest.now.orientation[2]), 0.2, byDoorWidth(1e-12, 1e-5));
  EXPECT_NEAR(guest.now.angular_velocity[2], 2.0, byDoorWidth(1e-12, 1e-5));
}

// The engine's own floor carries the cube, and only the engine knows of it.
TEST(Guest, StandsOnTheEnginesFloor) {
  for (const double rate : {60.0, 240.0}) {
    Guest guest;
    const double gravity[3] = {0.0, 0.0, -9.81}, step = 1.0 / rate;
    ok(tandem_world_set_gravity(guest.world, gravity));
    double lowest = 0.0;
    for (int i = 0; i < 120; ++i) {
      TandemState given{};
      ok(tandem_world_begin_step(guest.world, step, gravity, 1, &guest.cube, &guest.now, &given));
      guest.now = given;
      guest.now.velocity[2] += step * gravity[2];
      guest.now.velocity[2] = std::max(guest.now.velocity[2], -guest.now.position[2] / step);
      guest.now.position[2] += step * guest.now.velocity[2];
      ok(tandem_world_end_step(guest.world, 1, &guest.cube, &guest.now, &guest.now));
      lowest = std::min(lowest, guest.now.position[2]);
    }
    EXPECT_GT(lowest, -1e-6) << rate;
    EXPECT_LT(guest.now.position[2], 1e-6) << rate;
  }
}

// A change of velocity by the engine in its step enters the island in the next step, once.
TEST(Guest, KeepsTheMomentumOfAHit) {
  Guest guest;
  guest.now.velocity[0] = 1.0;
  guest.steps(3);
  // A ball of the host's own, of 0.3 kg, hits the cube fully elastically.
  constexpr double kBall = 0.3;
  double ball = 0.0;
  guest.step([&] {
    const double cube = guest.now.velocity[0];
    guest.now.velocity[0] = (kMass - kBall) / (kMass + kBall) * cube;
    ball = 2.0 * kMass / (kMass + kBall) * cube;
  });
  EXPECT_NEAR(guest.now.velocity[0], -0.5, byDoorWidth(1e-12, 1e-6));
  guest.steps(5);
  EXPECT_NEAR(guest.islandSpeed(), -0.5, byDoorWidth(1e-12, 1e-6));
  EXPECT_NEAR(kMass * guest.islandSpeed() + kBall * ball, kMass * 1.0, byDoorWidth(1e-12, 1e-7));
}

TEST(Guest, KeepsTheMomentumOfManyHits) {
  constexpr std::uint64_t kSeed = 11;
  SCOPED_TRACE(kSeed);
  Random random(kSeed);
  Guest guest;
  Vec3 given = Vec3::Zero();
  for (int i = 0; i < 500; ++i) {
    const Vec3 during = random.inCube(0.1), between = random.inCube(0.1);
    const bool is_hit = random.below(3) == 0, is_pushed = random.below(3) == 0;
    guest.step([&] {
      for (int k = 0; k < 3 && is_hit; ++k) guest.now.velocity[k] += during[k];
    });
    for (int k = 0; k < 3 && is_pushed; ++k) guest.now.velocity[k] += between[k];
    given += Vec3(is_hit * during + is_pushed * between);
  }
  guest.steps(2);
  EXPECT_LT((toVec3(guest.object().velocity) - given).norm(), byDoorWidth(1e-12, 1e-5));
  EXPECT_LT((toVec3(guest.now.velocity) - given).norm(), byDoorWidth(1e-12, 1e-5));
}

// Rounding by a host that keeps float states moves no body.
TEST(Guest, DoesNotTakeRoundingForTheHostsDoing) {
  Guest guest;
  guest.now.position[0] = 3.14159;
  guest.now.velocity[1] = 0.123456789;
  guest.steps(2);
  const auto round = [](double& value) { value = static_cast<double>(static_cast<float>(value)); };
  const double speed = guest.object().velocity[1];
  for (int i = 0; i < 240; ++i) {
    for (double& value : guest.now.position) round(value);
    for (double& value : guest.now.velocity) round(value);
    guest.step([&] {
      for (double& value : guest.now.velocity) round(value);
    });
  }
  EXPECT_EQ(guest.object().velocity[1], speed);
  // The island moved on by itself for a second at that speed.
  EXPECT_NEAR(guest.now.position[1], 242 * kStep * speed, byDoorWidth(1e-9, 1e-5));
}

TEST(Guest, IsMovedAndSteppedByItsOwnEngineOnly) {
  Guest guest;
  guest.step();
  EXPECT_EQ(tandem_world_set_state(guest.world, guest.cube, &guest.now), TANDEM_INVALID_ARGUMENT);
  TandemState given{};
  ok(tandem_world_begin_step(guest.world, kStep, nullptr, 1, &guest.cube, &guest.now, &given));
  EXPECT_EQ(tandem_world_step(guest.world, kStep, 0, 0.0), TANDEM_INVALID_ARGUMENT);
  ok(tandem_world_end_step(guest.world, 1, &guest.cube, &given, &guest.now));
}

// The hand presses a guest cube: the engine's body is at the island's pose.
TEST(Guest, IsPushedByTheHand) {
  FreeDoorCube pushed(makeWorld());
  const double hand[3] = {-0.0295, 0.0, 0.0}, still[3] = {0.0, 0.0, 0.0};
  ok(tandem_device_move(pushed.device, hand, still));
  TandemState now = pushed.body(pushed.cube), given{};
  for (int i = 0; i < 60; ++i) {
    ok(tandem_world_begin_step(pushed.world, kStep, nullptr, 1, &pushed.cube, &now, &given));
    for (int k = 0; k < 3; ++k) now.position[k] += kStep * given.velocity[k];
    now.velocity[0] = given.velocity[0];
    EXPECT_NEAR(now.position[0], pushed.body(pushed.cube).position[0], byDoorWidth(1e-12, 1e-7));
    ok(tandem_world_end_step(pushed.world, 1, &pushed.cube, &now, &now));
  }
  EXPECT_GT(now.position[0], 1e-3);
}

}  // namespace
}  // namespace tandem
