// Extreme numbers that no real scene has, found by `tandem bench stress`.

#include <cmath>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;  // haptic period [s]

IslandBody makeBall(double radius, double mass, const Vec3& p_W, const Vec3& v_W) {
  IslandBody ball;
  ball.shape = Sphere{radius};
  ball.mass = mass;
  ball.start.p_W = p_W;
  ball.start.v_W = v_W;
  return ball;
}

// No step meets the tolerance, and the shortest step divides the time except for rounding. The
// search for a shorter step used to loop for ever.
TEST(IslandStress, ShortestStepIsTakenWhateverItsError) {
  IslandSettings settings;
  settings.haptic_period = kPeriod;
  settings.tolerance = 1e-300;
  Island island(settings);
  const BodyIndex ball = island.addBody(makeBall(0.01, 0.1, Vec3(0.015, 0.0, 0.0), Vec3::Zero()));
  const BodyIndex other = island.addBody(makeBall(0.01, 0.1, Vec3::Zero(), Vec3::Zero()));
  island.addContact(ball, other, {10.0, 1.0});
  island.prepare();
  for (int i = 1; i <= 20; ++i) island.advance(kPeriod / 64.0 * (1.0 + i * 1e-10));
  EXPECT_GT(island.state(ball).v_W.x(), 0.0);
}

// B_r / J = 2.8e7 1/s is seven times what the shortest step can follow. The spin used to grow.
TEST(IslandStress, TurnDamperFasterThanAnyStepOnlyTakesEnergy) {
  Island island({});
  IslandBody capsule;
  capsule.shape = Capsule{2.5e-4, 3.2e-4};
  capsule.mass = 1.1e-3;                                  // [kg]
  capsule.inertia_B = Vec3(1.45e-10, 4.6e-11, 1.45e-10);  // [kg m^2]
  capsule.start.w_W = Vec3(3.0, 10.0, -5.0);
  const BodyIndex body = island.addBody(capsule);
  const CouplerIndex coupler = island.addCoupler(body, {{88.7, 389.0}, {2.9e-4, 1.3e-3}});
  island.prepare();
  island.setTarget(coupler, {});
  double spin = capsule.start.w_W.norm();
  for (int tick = 0; tick < 50; ++tick) {
    island.advance(kPeriod);
    const double now = island.state(body).w_W.norm();
    ASSERT_LE(now, spin) << "tick " << tick;
    spin = now;
  }
  EXPECT_LT(spin, 1e-3);
}

// The same for contacts: six balls of 1 g at the end of a needle of 1 g, with 1000 N s/m each.
TEST(IslandStress, ContactDamperFasterThanAnyStepOnlyTakesEnergy) {
  IslandSettings settings;
  settings.obstacle_contact = {10.0, 1e3};
  Island island(settings);
  const double mass = 1e-3;           // [kg]
  const Vec3 half(5e-3, 5e-4, 5e-4);  // [m]
  IslandBody needle;
  needle.shape = Box{half};
  needle.mass = mass;
  const Vec3 square = half.cwiseProduct(half);
  needle.inertia_B =
      mass / 3.0 * Vec3(square.y() + square.z(), square.x() + square.z(), square.x() + square.y());
  const BodyIndex body = island.addBody(needle);
  for (int i = 0; i < 6; ++i) {
    const BodyIndex ball = island.addBody(
        makeBall(1e-3, mass, Vec3(4e-3 + 1e-4 * i, 0.0, 1.4e-3), Vec3(0.0, 0.0, -5.0)));
    island.addContact(ball, body, {10.0, 1e3});
  }
  island.prepare();
  const auto computeEnergy = [&] {
    double energy = 0.0;
    for (BodyIndex b = 0; b < island.bodyCount(); ++b) {
      const RigidState& state = island.state(b);
      const Vec3 w_B = state.q_WB.conjugate() * state.w_W;
      energy += 0.5 * mass * state.v_W.squaredNorm() +
                0.5 * w_B.dot(island.body(b).inertia_B.cwiseProduct(w_B));
    }
    return energy;
  };
  const double springs =
      6.0 * 0.5 * 10.0 * 1e-6;  // energy of overlaps no deeper than a ball's radius [J]
  double energy = computeEnergy();
  for (int tick = 0; tick < 20; ++tick) {
    island.advance(kPeriod);
    ASSERT_LE(computeEnergy(), energy + springs) << "tick " << tick;
    energy = computeEnergy();
  }
}

// At half a turn the coupler's torque jumps to the opposite direction. A step across the jump used
// to create energy, each time up to torque x angle of the step.
TEST(IslandStress, TurningOverMakesNoEnergy) {
  Island island({});
  const double inertia = 2e-5, stiffness = 0.5;  // [kg m^2], [N m/rad]
  IslandBody cube;
  cube.shape = Box{Vec3::Constant(0.02)};
  cube.mass = 0.1;
  cube.inertia_B = inertia * Vec3(1.0, 1.3, 0.8);
  // The spin is just enough to pass half a turn: K pi^2 / 2 < J w^2 / 2.
  cube.start.w_W = 1.02 * M_PI * std::sqrt(stiffness / inertia) * Vec3::UnitX() + Vec3(0, 9, 4);
  const BodyIndex body = island.addBody(cube);
  const CouplerIndex coupler = island.addCoupler(body, {{200.0, 0.0}, {stiffness, 0.0}});
  island.prepare();
  island.setTarget(coupler, {});
  const auto computeEnergy = [&] {
    const RigidState& state = island.state(body);
    const Vec3 w_B = state.q_WB.conjugate() * state.w_W;
    const double half_turn = std::acos(std::min(1.0, std::abs(state.q_WB.w())));
    return 0.5 * w_B.dot(cube.inertia_B.cwiseProduct(w_B)) +
           2.0 * stiffness * half_turn * half_turn;
  };
  const double start = computeEnergy();
  int turned_over = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const double before = island.state(body).q_WB.w();
    island.advance(kPeriod);
    turned_over += before * island.state(body).q_WB.w() < 0.0;
    ASSERT_LE(computeEnergy(), start * (1.0 + 1e-6)) << "tick " << tick;
  }
  EXPECT_GT(turned_over, 3);
}

// Two balls each touch a held body; one is shot at the other from rest within a tick. As neither
// was alone, their meeting was never checked. The shot went on inside the other ball and created
// energy.
TEST(IslandStress, WhoIsShotOutOfOneTouchMeetsTheNext) {
  const double stiffness = 3e5, radius = 0.02, mass = 0.14;  // [N/m], [m], [kg]
  const CouplerGains gains{stiffness, 0.0};
  Island island({});
  island.setTouchMemory(false);
  IslandBody held = makeBall(radius, 0.0, Vec3::Zero(), Vec3::Zero());
  held.motion = Motion::kHeld;
  const double shot_overlap = 0.03, hit_overlap = 0.001, gap = 0.004;
  const double shot_start = 2.0 * radius - shot_overlap;
  const double hit_start = shot_start + 2.0 * radius + gap;
  const BodyIndex behind = island.addBody(held);
  held.start.p_W.x() = hit_start + 2.0 * radius - hit_overlap;
  const BodyIndex ahead = island.addBody(held);
  const BodyIndex shot =
      island.addBody(makeBall(radius, mass, Vec3(shot_start, 0, 0), Vec3::Zero()));
  const BodyIndex hit =
      island.addBody(makeBall(radius, 50.0 * mass, Vec3(hit_start, 0, 0), Vec3::Zero()));
  island.addContact(shot, behind, gains);
  island.addContact(hit, ahead, gains);
  island.addContact(shot, hit, gains);
  island.prepare();
  const auto store = [&](BodyIndex a, BodyIndex b) {
    const double distance = (island.state(a).p_W - island.state(b).p_W).norm();
    const double overlap = std::max(0.0, 2.0 * radius - distance);
    return 0.5 * stiffness * overlap * overlap;
  };
  const auto computeEnergy = [&] {
    return store(shot, behind) + store(hit, ahead) + store(shot, hit) +
           0.5 * mass * island.state(shot).v_W.squaredNorm() +
           25.0 * mass * island.state(hit).v_W.squaredNorm();
  };
  const double start = computeEnergy();
  for (int tick = 0; tick < 5; ++tick) {
    island.advance(kPeriod);
    ASSERT_NEAR(computeEnergy(), start, 1e-5 * start) << "tick " << tick;
  }
}

// A ball of 1 g swings on a coupler, 0.4 rad in a haptic period, and grazes a post at the turn. The
// touch lasts less than 0.09 rad. A slot used to check only the ends of a step of half a radian,
// and missed most touches.
TEST(IslandStress, TouchWithinAStepOfASlotIsFelt) {
  const double mass = 1e-3, stiffness = 160.0, post_stiffness = 800.0;  // [kg], [N/m]
  const double radius = 0.01, way = 0.01, clearance = 0.999 * way;      // [m]
  IslandSettings settings;
  settings.haptic_period = kPeriod;
  settings.guide = Vec3::UnitX();
  Island island(settings);
  const BodyIndex ball = island.addBody(makeBall(radius, mass, Vec3::Zero(), Vec3::Zero()));
  IslandBody held = makeBall(radius, 0.0, Vec3(2.0 * radius + clearance, 0, 0), Vec3::Zero());
  held.motion = Motion::kHeld;
  const BodyIndex post = island.addBody(held);
  const CouplerIndex coupler = island.addCoupler(ball, {{stiffness, 0.0}, {}});
  island.addContact(ball, post, {post_stiffness, 0.0});
  island.prepare();
  island.setTarget(coupler, {});
  RigidState start;
  start.p_W.x() = -way;
  island.setState(ball, start);

  // x = -A cos(w1 t) until the touch at t1, then middle + a cos(w2 (t - t1 - t2)), and back.
  const double w1 = std::sqrt(stiffness / mass);
  const double w2 = std::sqrt((stiffness + post_stiffness) / mass);
  const double t1 = (M_PI - std::acos(clearance / way)) / w1;
  const double speed = w1 * std::sqrt(way * way - clearance * clearance);
  const double middle = post_stiffness * clearance / (stiffness + post_stiffness);
  const double t2 = std::atan2(speed / w2, clearance - middle) / w2;
  const double a = std::hypot(speed / w2, clearance - middle);
  for (int tick = 1; tick <= 1000; ++tick) {
    island.advance(kPeriod);
    const double since = std::fmod(tick * kPeriod, 2.0 * (t1 + t2));
    const double t = std::min(since, 2.0 * (t1 + t2) - since);
    const double x = t < t1 ? -way * std::cos(w1 * t) : middle + a * std::cos(w2 * (t1 + t2 - t));
    ASSERT_NEAR(island.state(ball).p_W.x(), x, 1e-9) << "tick " << tick;
  }
}

}  // namespace
}  // namespace tandem
