// Two users each push a round peg of 20 mm into a hole of 20.2 mm, at both sites, over a network.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "tandem/coordination/simulated_link.h"

#include "grip/tool_rig.h"

namespace tandem {
namespace {

using test::byWidth;
using test::glide;
using test::kHostStep;
using test::ToolHost;
using test::turn;
using test::WristDevice;

constexpr double kPeg = 0.010, kHole = 0.0101;       // radii [m]
constexpr double kHalfLength = 0.03, kDepth = 0.04;  // of the peg, of the hole [m]
constexpr int kWalls = 16;                           // around the hole
constexpr double kWall = 0.01;                       // half thickness of a wall [m]
constexpr double kPegMass = 0.05;                    // [kg]
constexpr double kIn = 0.035;                        // how far the hand pushes the peg in [m]

/// How a hand misses the middle of the hole.
struct Miss {
  Vec3 offset_W = Vec3::Zero();  // of the peg's tip, across the hole [m]
  Vec3 axis_W = Vec3::UnitX();   // of the tilt
  double tilt = 0.0;             // [rad]
};

/// Over the hole at `hole_W`, then into it. The peg's tip leads. The hand is tilted, and
/// straightens once the peg is in.
WristDevice::Path insert(const Vec3& hole_W, const Miss& miss) {
  return [=](double t) {
    const Quat q_WH = turn(miss.tilt * (glide(t, 0.0, 0.2) - glide(t, 1.1, 1.4)), miss.axis_W);
    const double tip = 0.005 - (0.005 + kIn) * glide(t, 0.2, 1.2);
    return WristDevice::Pose{
        hole_W + miss.offset_W + Vec3(0, 0, tip) + q_WH * Vec3(0, 0, kHalfLength), q_WH};
  };
}

Vec3 wallNormal(int wall) {
  const double angle = 2.0 * M_PI * wall / kWalls;
  return {std::cos(angle), std::sin(angle), 0.0};
}

/// Depth of a point in the board around a hole at the origin; <= 0 if it is free [m].
double findDepth(const Vec3& p) {
  double outside = -1.0;
  for (int wall = 0; wall < kWalls; ++wall)
    outside = std::max(outside, wallNormal(wall).dot(p) - kHole);
  return std::min(outside, -p.z());
}

/// Overlap of a peg and the board around a hole at the origin [m].
double findOverlap(const RigidState& peg) {
  double overlap = 0.0;
  const Vec3 axis = peg.q_WB * Vec3::UnitZ();
  for (int i = 0; i < 10 * kWalls; ++i) {
    const double angle = 2.0 * M_PI * i / (10 * kWalls);
    const Vec3 side = peg.q_WB * Vec3(std::cos(angle), std::sin(angle), 0.0);
    const Vec3 rim = peg.p_W - kHalfLength * axis + kPeg * side;
    overlap = std::max(overlap, findDepth(rim));
    // Where this line of the peg's side crosses the board's top.
    const Vec3 crossing = rim - rim.z() / axis.z() * axis;
    if (rim.z() < 0.0) {
      double outside = -1.0;
      for (int wall = 0; wall < kWalls; ++wall)
        outside = std::max(outside, wallNormal(wall).dot(crossing) - kHole);
      overlap = std::max(overlap, outside);
    }
  }
  return overlap;
}

const std::array<Vec3, 2> kHoles = {Vec3(-0.1, 0, 0), Vec3(0.1, 0, 0)};

/// A host with both holes and both pegs; user `self` has the peg of that place.
struct PegHost : ToolHost {
  std::array<btRigidBody*, 2> pegs{};

  PegHost(std::size_t self, const Miss& miss) : ToolHost(insert(kHoles[self], miss)) {
    settings.self = PeerId{static_cast<std::uint32_t>(self + 1)};
    settings.peers = 2;
    auto& wall = rig.makeShape<btBoxShape>(toBullet(Vec3(kWall, 0.0045, kDepth / 2)));
    auto& peg = rig.makeShape<btCylinderShapeZ>(toBullet(Vec3(kPeg, kPeg, kHalfLength)));
    for (std::size_t i = 0; i < 2; ++i) {
      for (int w = 0; w < kWalls; ++w) {
        const Vec3 p_W = kHoles[i] + (kHole + kWall) * wallNormal(w) - Vec3(0, 0, kDepth / 2);
        rig.addBody(wall, 0.0, p_W, turn(2.0 * M_PI * w / kWalls, Vec3::UnitZ()))
            .setFriction(btScalar(0.55));
      }
    }
    attach();
    for (std::size_t i = 0; i < 2; ++i) {
      pegs[i] = &rig.addBody(peg, kPegMass, kHoles[i] + Vec3(0, 0, kHalfLength + 0.005));
      pegs[i]->setFriction(static_cast<btScalar>(0.3 / 0.55));
      site->shareTool(*pegs[i], PeerId{static_cast<std::uint32_t>(i + 1)});
    }
  }
};

struct Inserted {
  double overlap = 0.0;  // most, of any peg at any site [m]
  double depth = 1.0;    // least, in the end [m]
  double force = 0.0;    // most [N]
};

Inserted run(double delay, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  std::array<Miss, 2> misses;
  for (Miss& miss : misses) {
    miss.offset_W = 7e-5 * Vec3(part(random), part(random), 0.0);
    miss.axis_W = Vec3(part(random), part(random), 0.0).normalized();
    miss.tilt = 0.05 * part(random);
  }
  std::array<std::unique_ptr<PegHost>, 2> hosts;
  for (std::size_t i = 0; i < 2; ++i) hosts[i] = std::make_unique<PegHost>(i, misses[i]);
  Impairments network;
  network.delay = delay;
  network.seed = seed;
  std::array<std::unique_ptr<SimulatedLink>, 2> links;
  std::tie(links[0], links[1]) = makeSimulatedLinks(network, 4096);
  for (std::uint32_t i = 0; i < 2; ++i)
    hosts[i]->site->connect(PeerId{2 - i}, *links[i], hosts[1 - i]->device.at(0.0).p_W);

  Inserted found;
  while (hosts[0]->now < 1.7) {
    for (auto& host : hosts) {
      host->run(kHostStep);
      for (std::uint32_t peg = 0; peg < 2; ++peg) {
        RigidState state = host->site->object(peg);
        state.p_W -= kHoles[peg];
        found.overlap = std::max(found.overlap, findOverlap(state));
      }
      found.force = std::max(found.force, host->site->force().norm());
    }
  }
  for (auto& host : hosts)
    for (std::uint32_t peg = 0; peg < 2; ++peg)
      found.depth = std::min(found.depth, kHalfLength - host->site->object(peg).p_W.z());
  return found;
}

class PegInHole : public testing::TestWithParam<double> {};

TEST_P(PegInHole, GoesInAtBothSites) {
  const int times = static_cast<int>(byWidth(20, 5));
  int in = 0;
  double overlap = 0.0;
  for (int seed = 1; seed <= times; ++seed) {
    const Inserted found = run(GetParam(), static_cast<std::uint64_t>(seed));
    const bool is_in = found.depth > 0.98 * kIn;
    std::printf("delay %.0f ms, seed %2d: %.2f mm in, overlap %.5f mm, most %.2f N\n",
                1e3 * GetParam(), seed, 1e3 * found.depth, 1e3 * found.overlap, found.force);
    in += is_in;
    overlap = std::max(overlap, found.overlap);
  }
  EXPECT_EQ(in, times);
  EXPECT_LT(overlap, 5e-5);
}
INSTANTIATE_TEST_SUITE_P(Delays, PegInHole, testing::Values(0.05, 0.15));

}  // namespace
}  // namespace tandem
