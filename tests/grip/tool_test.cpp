// A tool in the hand: what turns, what is felt, and what it touches.

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <tuple>

#include <gtest/gtest.h>

#include "tandem/coordination/simulated_link.h"

#include "grip/tool_rig.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::glide;
using test::kHostStep;
using test::reasonOf;
using test::ToolHost;
using test::turn;
using test::WristDevice;

const Vec3 kStick(0.01, 0.01, 0.06);  // half extents [m]
constexpr double kMass = 0.05;        // of a tool [kg]

/// A stick in a world without gravity, held in its middle.
struct Stick : ToolHost {
  btRigidBody& body;

  explicit Stick(WristDevice::Path path)
      : ToolHost(std::move(path)),
        body(rig.addBody(rig.makeShape<btBoxShape>(toBullet(kStick)), kMass)) {
    attach();
    site->shareTool(body, PeerId{1});
  }
};

double angleBetween(const Quat& a, const Quat& b) { return a.angularDistance(b); }

TEST(Tool, TurnsWithTheWrist) {
  const Vec3 axis = Vec3(1, 2, -1).normalized();
  Stick host([&](double t) {
    return WristDevice::Pose{Vec3(0.1 * glide(t, 0.2, 1.0), 0, 0),
                             turn(2.0 * glide(t, 0.2, 1.0), axis)};
  });
  double lag = 0.0;
  host.run(0.9, [&] {
    lag = std::max(lag, angleBetween(host.site->object(0).q_WB, host.device.at(host.now).q_WH));
  });
  host.run(1.0);
  std::printf("a stick turned by 2 rad lags by %.4f rad\n", lag);
  EXPECT_LT(lag, 0.02);
  EXPECT_LT(angleBetween(host.site->object(0).q_WB, turn(2.0, axis)), 1e-6);
  EXPECT_LT((host.site->object(0).p_W - Vec3(0.1, 0, 0)).norm(), 1e-6);
  EXPECT_LT(host.site->force().norm(), 1e-3);
}

// The hand presses the stick's end onto a table: the whole force comes from the hold.
TEST(Tool, PressesByItsHoldAlone) {
  Stick host([](double t) {
    return WristDevice::Pose{Vec3(0, 0, -0.004 * glide(t, 0.1, 0.5)), Quat::Identity()};
  });
  host.rig.addBody(host.rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), 0.0,
                   Vec3(0, 0, -1.0 - kStick.z()));
  host.run(2.0);
  EXPECT_NEAR(host.site->object(0).p_W.z(), 0.0, 1e-5);
  EXPECT_NEAR(host.site->force().z(), 0.004 * host.settings.tool.stiffness, 1e-3 * 6.0);
  EXPECT_LT(host.site->force().head<2>().norm(), 1e-3);
}

// Pressed beside the middle of its end on an edge, the stick wants to turn: the hand feels it.
TEST(Tool, GivesTheHandATorque) {
  Stick host([](double t) {
    return WristDevice::Pose{Vec3(0, 0, -0.002 * glide(t, 0.1, 0.5)), Quat::Identity()};
  });
  host.rig.addBody(host.rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), 0.0,
                   Vec3(1.005, 0, -1.0 - kStick.z()));
  host.run(3.0);
  const Vec3 force_W = host.site->force(), torque_W = host.site->torque();
  EXPECT_EQ(host.device.torque_W, torque_W);
  // In equilibrium the hold's wrench is that of the table on the stick, at the edge.
  const RigidState& stick = host.site->object(0);
  const Vec3 arm_W = Vec3(0.005, 0, -kStick.z()) - stick.p_W;
  std::printf("force %.4f N, torque %.5f N m, arm %.5f m\n", force_W.z(), torque_W.y(), arm_W.x());
  EXPECT_GT(force_W.z(), 1.0);
  EXPECT_NEAR(torque_W.y(), arm_W.cross(force_W).y(), 0.02 * std::abs(torque_W.y()) + 1e-5);
}

// A round peg is pushed against a wall. A float Bullet's search for nearest points ends at about a
// millimetre: beside a wall of 9 mm the peg went 0.3 mm into it.
TEST(Tool, TouchesANarrowWallAsAWideOne) {
  for (const double half_width : {0.0045, 0.02, 0.5}) {
    ToolHost host([](double t) {
      return WristDevice::Pose{Vec3(1e-3 * glide(t, 0.3, 0.8), 0, 0), Quat::Identity()};
    });
    auto& wall = host.rig.makeShape<btBoxShape>(toBullet(Vec3(0.01, half_width, 0.02)));
    host.rig.addBody(wall, 0.0, Vec3(0.0201, 0, 0));
    auto& peg = host.rig.makeShape<btCylinderShapeZ>(toBullet(Vec3(0.01, 0.01, 0.03)));
    btRigidBody& body = host.rig.addBody(peg, kMass);
    host.attach();
    host.site->shareTool(body, PeerId{1});
    host.run(1.5);
    EXPECT_NEAR(host.site->object(0).p_W.x(), 1e-4, 5e-6) << half_width;
  }
}

TEST(Tool, IsRefusedToOthers) {
  ToolHost host([](double) { return WristDevice::Pose{}; });
  btRigidBody& own = host.rig.addCube(0.1);
  btRigidBody& other = host.rig.addCube(0.1, 0.02, Vec3(0.3, 0, 0));
  host.attach();
  host.site->shareTool(own, PeerId{1});
  host.site->shareTool(other, PeerId{2});
  EXPECT_EQ(reasonOf([&] { host.site->grab(1); }),
            "object 1 is the tool of user 2; a hand holds objects and its own tool");
  EXPECT_EQ(reasonOf([&] {
              host.site->shareTool(host.rig.addCube(0.1, 0.02, Vec3(0, 1, 0)), PeerId{1});
            }),
            "the hand holds something already; release it first");
}

/// Two hosts with a stick of user 1 and a shared cube on a table.
struct TwoToolHosts {
  std::array<std::unique_ptr<ToolHost>, 2> hosts;
  std::array<std::unique_ptr<SimulatedLink>, 2> links;

  explicit TwoToolHosts(const WristDevice::Path& path, double delay) {
    Impairments network;
    network.delay = delay;
    std::tie(links[0], links[1]) = makeSimulatedLinks(network, 4096);
    const auto away = [](double) { return WristDevice::Pose{Vec3(0, 0.5, 0.5), Quat::Identity()}; };
    for (std::uint32_t i = 0; i < 2; ++i) {
      hosts[i] = std::make_unique<ToolHost>(i == 0 ? path : away, Vec3(0, 0, -9.81));
      ToolHost& host = *hosts[i];
      host.settings.self = PeerId{i + 1};
      host.settings.peers = 2;
      host.rig.addBody(host.rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), 0.0, Vec3(0, 0, -1));
      host.attach();
      host.site->share(host.rig.addCube(0.2, 0.02, Vec3(0.1, 0, 0.02)));
      btRigidBody& stick = host.rig.addBody(host.rig.makeShape<btBoxShape>(toBullet(kStick)), kMass,
                                            Vec3(0, 0, 0.08));
      stick.setGravity(btVector3(0, 0, 0));
      host.site->shareTool(stick, PeerId{1});
      host.site->connect(PeerId{2 - i}, *links[i], i == 0 ? away(0.0).p_W : path(0.0).p_W);
    }
  }
  void run(
      double duration, const std::function<void()>& look = [] {}) {
    for (const double end = hosts[0]->now + duration; hosts[0]->now < end - 1e-9; look())
      for (auto& host : hosts) host->run(kHostStep);
  }
  [[nodiscard]] Site& site(int i) { return *hosts[i]->site; }
};

// The stick's copy at the peer goes and turns as the user's hand did, a delay ago. It pushes the
// shared cube there, too, so both sites see the cube pushed.
TEST(Tool, ActsAtThePeerThroughTheUsersProxy) {
  const auto path = [](double t) {
    return WristDevice::Pose{Vec3(0.12 * glide(t, 0.5, 1.5), 0, 0.08),
                             turn(0.4 * glide(t, 0.5, 1.5), Vec3::UnitZ())};
  };
  TwoToolHosts hosts(path, 0.05);
  hosts.run(3.0);
  const RigidState here = hosts.site(0).object(1), there = hosts.site(1).object(1);
  std::printf("stick: %.3f mm apart, %.4f rad; cube at %.4f and %.4f m\n",
              1e3 * (here.p_W - there.p_W).norm(), here.q_WB.angularDistance(there.q_WB),
              hosts.site(0).object(0).p_W.x(), hosts.site(1).object(0).p_W.x());
  EXPECT_LT((here.p_W - there.p_W).norm(), 2e-3);
  EXPECT_LT(here.q_WB.angularDistance(there.q_WB), 0.02);
  EXPECT_LT(there.q_WB.angularDistance(turn(0.4, Vec3::UnitZ())), 0.05);
  for (int i = 0; i < 2; ++i) {
    EXPECT_GT(hosts.site(i).object(0).p_W.x(), 0.13);
    EXPECT_EQ(hosts.site(i).status(), 0u);
  }
  EXPECT_LT((hosts.site(0).object(0).p_W - hosts.site(1).object(0).p_W).norm(), 2e-3);
}

// Nobody ties a tool's copies: at a delay of 0.2 s a tie would pull the hand back by K_t times the
// way of 0.2 s.
TEST(Tool, IsNotDraggedByItsCopies) {
  const auto path = [](double t) {
    return WristDevice::Pose{Vec3(0, 0.3 * glide(t, 0.5, 1.5), 0.2), Quat::Identity()};
  };
  TwoToolHosts hosts(path, 0.2);
  double most = 0.0;
  hosts.run(0.45);  // it comes to the hand
  hosts.run(2.0, [&] { most = std::max(most, hosts.site(0).force().norm()); });
  std::printf("moved freely at up to 0.56 m/s: %.3f N\n", most);
  // Its inertia alone: kMass at 0.3 m 10/sqrt(3) 1/s^2.
  EXPECT_NEAR(most, kMass * 0.3 * 5.77, 0.01);
}

// A hand that lays its tool down feels things itself again.
TEST(Tool, CanBeLaidDownAndTakenUp) {
  const auto path = [](double t) {
    return WristDevice::Pose{
        Vec3(0, 0, 0.07 - 0.06 * glide(t, 1.0, 2.0) + 0.05 * glide(t, 3.0, 4.0)), Quat::Identity()};
  };
  ToolHost host(path, Vec3(0, 0, -9.81));
  host.rig.addBody(host.rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), 0.0, Vec3(0, 0, -1.0));
  btRigidBody& stick =
      host.rig.addBody(host.rig.makeShape<btBoxShape>(toBullet(kStick)), kMass, Vec3(0, 0, 0.07));
  host.attach();
  const ObjectId id = host.site->shareTool(stick, PeerId{1});
  host.run(0.9);
  ASSERT_TRUE(host.site->grip());
  EXPECT_NEAR(host.site->force().z(), -9.81 * kMass, 0.02);  // its weight
  host.site->release();
  host.run(1.5);
  EXPECT_FALSE(host.site->grip());
  EXPECT_LT(host.site->object(id).p_W.z(), kStick.z() + 1e-3);
  host.run(2.0);
  host.site->grab(id, Vec3::Zero());
  host.run(1.0);
  EXPECT_TRUE(host.site->grip());
  EXPECT_LT((host.site->object(id).p_W - host.site->hip().p_W).norm(), 1e-3);
}

// The energy that the hand gets out of a hold it has put in before.
TEST(Tool, GivesBackNoMoreThanItGot) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    test::Random random(seed);
    const Vec3 swing = random.inCube(0.03), turns = random.inCube(0.8);
    const double rate = random.uniform(4.0, 12.0);
    Stick host([&](double t) {
      const double s = glide(t, 0.1, 0.5) * std::sin(rate * t);
      const double angle = (s * turns).norm();
      return WristDevice::Pose{s * swing, turn(angle > 0 ? (s > 0 ? angle : -angle) : 0.0, turns)};
    });
    host.rig.addBody(host.rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), 0.0,
                     Vec3(0, 0, -1.0 - kStick.z()));
    double work = 0.0, least = 0.0;
    PointState last;
    for (int step = 0; step < 300; ++step) {
      const Vec3 force_W = host.site->force(), p_W = host.site->hip().p_W;
      host.run(kHostStep);
      work -= force_W.dot(host.site->hip().p_W - p_W);
      least = std::min(least, work);
    }
    EXPECT_TRUE(isFinite(host.site->object(0))) << seed;
    EXPECT_LT(host.site->force().norm(), 60.0) << seed;
    EXPECT_GT(least, -0.05) << seed;
  }
}

}  // namespace
}  // namespace tandem
