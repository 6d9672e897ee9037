// Worlds of bodies in joints at a host of 60 Hz, beside a converged run of the same world: a host
// of 1 kHz, and sixteen inner steps in each tick.

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "physics/joint_host.h"
#include "physics/ragdoll.h"

namespace tandem {
namespace {

using test::JointHost;
using test::Ragdoll;

constexpr double kDuration = 1.0;  // [s]
constexpr int kLooks = 20;         // comparisons per second, at ends of steps of both hosts

/// A device that goes steadily from a place, and keeps the forces that it got.
class SteadyDevice final : public HapticDevice {
 public:
  SteadyDevice(const Vec3& p_W, const Vec3& v_W) : p_W_(p_W), v_W_(v_W) { forces_W.reserve(2000); }
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return capabilities_;
  }
  [[nodiscard]] DeviceSample read(double now) noexcept override {
    return {{p_W_ + now * v_W_, v_W_}, true};
  }
  void write(const Vec3& f_W) noexcept override { forces_W.push_back(f_W); }

  std::vector<Vec3> forces_W;  ///< of each tick

 private:
  DeviceCapabilities capabilities_{"steady"};
  Vec3 p_W_, v_W_;
};

/// A run shows this.
struct Motion {
  std::vector<std::vector<Vec3>> places_W;  ///< by look and body
  std::vector<Vec3> forces_W;               ///< on the hand, by tick
};

/// A world: its bodies and joints, and the index of the body that is shared.
using World = std::function<std::size_t(JointHost&)>;

Motion run(const World& build, const Vec3& hand_W, const Vec3& v_W, int rate, double inner_step) {
  JointHost host;
  SteadyDevice device(hand_W, v_W);
  const std::size_t shared = build(host);
  SiteSettings settings;
  settings.peers = 1;
  settings.contact = {1000.0, 5.0};
  settings.host_step = 1.0 / rate;
  settings.inner_step = inner_step;
  settings.max_neighbours = 32;
  settings.max_slew = 1e9;
  host.site = std::make_unique<Site>(settings, host.rig.world, device);
  host.site->share(*host.links[shared]);
  Motion motion;
  for (int step = 1; step <= kDuration * rate; ++step) {
    host.rig.step(1.0 / rate);
    if (step % (rate / kLooks) != 0) continue;
    motion.places_W.emplace_back();
    for (const btRigidBody* link : host.links)
      motion.places_W.back().push_back(fromBullet(link->getWorldTransform().getOrigin()));
  }
  EXPECT_TRUE(host.site->warnings().empty()) << host.site->warnings()[0];
  // The others came with the shared one; what rests may go and come again.
  EXPECT_GE(host.site->counters().promoted, host.links.size() - 1);
  motion.forces_W = device.forces_W;
  return motion;
}

struct Difference {
  double place = 0.0, force = 0.0, felt = 0.0, moved = 0.0;
};

/// Largest differences, the largest force, and the longest way of a body [m, N].
Difference compare(const Motion& a, const Motion& b) {
  Difference most;
  EXPECT_EQ(a.places_W.size(), b.places_W.size());
  for (std::size_t n = 0; n < std::min(a.places_W.size(), b.places_W.size()); ++n)
    for (std::size_t i = 0; i < a.places_W[n].size(); ++i) {
      most.place = std::max(most.place, (a.places_W[n][i] - b.places_W[n][i]).norm());
      most.moved = std::max(most.moved, (a.places_W[n][i] - a.places_W[0][i]).norm());
    }
  for (std::size_t n = 0; n < std::min(a.forces_W.size(), b.forces_W.size()); ++n) {
    most.force = std::max(most.force, (a.forces_W[n] - b.forces_W[n]).norm());
    most.felt = std::max(most.felt, a.forces_W[n].norm());
  }
  return most;
}

/// Compares a host of 60 Hz with the converged run.
void expectConverged(const World& build, const Vec3& hand_W, const Vec3& v_W) {
  const Difference most = compare(run(build, hand_W, v_W, 60, SiteSettings{}.inner_step),
                                  run(build, hand_W, v_W, 1000, 1.0 / 16000.0));
  EXPECT_LT(most.place, 5e-5);
  EXPECT_LT(most.force, 0.07);
  EXPECT_GT(most.felt, 1.0);
  EXPECT_GT(most.moved, 0.03);
  ::testing::Test::RecordProperty("place_um", std::to_string(1e6 * most.place));
  ::testing::Test::RecordProperty("force_mN", std::to_string(1e3 * most.force));
}

// Bullet's SimpleJoint: two boxes on a ball at the edge of one. The hand pushes the other.
TEST(JoinedWorlds, APairOnABall) {
  expectConverged(
      [](JointHost& host) -> std::size_t {
        auto& shape = host.rig.makeShape<btBoxShape>(toBullet(Vec3(0.1, 0.1, 0.025)));
        host.add(shape, 1.0, Vec3(0, 0, 0));
        host.add(shape, 1.0, Vec3(0.25, 0, 0));
        host.rig.world.setGravity(btVector3(0, 0, 0));
        host.join<btPoint2PointConstraint>(*host.links[0], *host.links[1],
                                           toBullet(Vec3(0.125, 0.05, 0)),
                                           toBullet(Vec3(-0.125, 0.05, 0)));
        return 0;
      },
      Vec3(-0.05, -0.02, -0.04), Vec3(0, 0, 0.15));
}

World hangRagdoll() {
  return [](JointHost& host) -> std::size_t {
    host.rig.world.setGravity(btVector3(0, btScalar(-9.81), 0));
    Ragdoll ragdoll(host);
    host.join<btPoint2PointConstraint>(ragdoll.part(Ragdoll::kSpine), toBullet(Vec3(0, 0.15, 0)));
    return Ragdoll::kSpine;
  };
}

// It hangs by its neck. Its arms fall, and the hand pushes its chest.
TEST(JoinedWorlds, ARagdollThatHangs) {
  expectConverged(hangRagdoll(), Vec3(0.02, 0.63, 0.095), Vec3(0, 0, -0.15));
}

// Twenty links hang, and the hand pushes the last.
TEST(JoinedWorlds, AChainOfTwenty) {
  expectConverged(
      [](JointHost& host) -> std::size_t {
        auto& shape = host.rig.makeShape<btBoxShape>(toBullet(Vec3(0.01, 0.01, 0.02)));
        const btVector3 top(0, 0, btScalar(0.025)), foot(0, 0, btScalar(-0.025));
        for (int i = 0; i < 20; ++i) {
          btRigidBody& link = host.add(shape, 0.1, Vec3(0, 0, -0.025 - 0.05 * i));
          if (i == 0)
            host.join<btPoint2PointConstraint>(link, top);
          else
            host.join<btPoint2PointConstraint>(link, *host.links[host.links.size() - 2], top, foot);
        }
        return 19;
      },
      Vec3(-0.025, 0.002, -0.97), Vec3(0.15, 0, 0));
}

}  // namespace
}  // namespace tandem
