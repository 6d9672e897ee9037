// Bullet's own examples with a site attached. While nothing is shared, each stays the same to the
// bit. With a shared body and a hand that pushes it, no energy comes from nowhere.

#include "host/example_scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "support/fakes.h"

namespace tandem {
namespace {

using test::ExampleHost;
using test::ExampleScene;
using test::FakeDevice;

class BulletsExample : public ::testing::TestWithParam<ExampleScene> {};

int countSteps(const ExampleHost& host, double duration) {
#ifdef __SANITIZE_ADDRESS__
  duration = std::min(duration, 0.5);  // fifteen times as slow
#endif
  return static_cast<int>(std::lround(duration / host.dt));
}

/// Where a hand in the scene has something to feel.
Vec3 findMiddle(const ExampleHost& host) {
  return host.offered().empty() ? fromBullet(host.guest_at)
                                : fromBullet(host.offered()[0]->getCenterOfMassPosition());
}

TEST_P(BulletsExample, IsTheSameToTheBitWithAHandAlone) {
  ExampleHost bare, host;
  GetParam().build(bare);
  GetParam().build(host);
  const Vec3 middle = findMiddle(host);
  FakeDevice device(middle);
  SiteSettings settings;
  settings.hand_feels_moving_bodies = false;  // the hand is amid the bodies
  const Site site(settings, host.world(), device);
  const std::uint64_t start = bare.hash();
  const int steps = countSteps(host, GetParam().duration);
  for (int i = 0; i < steps; ++i) {
    device.sample.hip.p_W = middle + Vec3(0.01 * (i % 100), 0.005 * (i % 70), 0.0);
    bare.step();
    host.step();
    ASSERT_EQ(bare.hash(), host.hash()) << "after step " << i + 1;
  }
  EXPECT_NE(bare.hash(), start) << "nothing moves";
  EXPECT_EQ(site.neighbourCount(), 0);
}

/// A hand that follows a body at up to 2 m/s, circles through it, and has a force of 30 N.
class PokingHand final : public HapticDevice {
 public:
  void putTo(const Vec3& p_W) { p_W_ = p_W; }
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return capabilities_;
  }
  [[nodiscard]] DeviceSample read(double now) noexcept override {
    constexpr double kSpeed = 2.0, kForce = 30.0;
    const double dt = std::clamp(now - last_, 0.0, 1e-3);
    last_ = now;
    const Vec3 to_goal = goal_W - p_W_;
    const bool is_pushed_back = f_W_.norm() > kForce;
    const Vec3 way = is_pushed_back ? f_W_ : to_goal;
    const double length = way.norm();
    const double part = length > 0.0 ? std::min(kSpeed * dt, length) / length : 0.0;
    way_W_ = part * way;
    p_W_ += way_W_;
    return {{p_W_, dt > 0.0 ? Vec3(way_W_ / dt) : Vec3::Zero()}, true};
  }
  void write(const Vec3& f_W) noexcept override {
    // The mean of both forces makes the work of a spring exact.
    const double work = -0.5 * (f_W_ + f_W).dot(way_W_);
    given += work;
    most_given = std::max(most_given, given);
    f_W_ = f_W;
  }

  Vec3 goal_W = Vec3::Zero();
  double given = 0.0, most_given = 0.0;  ///< work of the hand so far, and its maximum [J]

 private:
  DeviceCapabilities capabilities_{"poking hand"};
  Vec3 p_W_ = Vec3::Zero(), way_W_ = Vec3::Zero(), f_W_ = Vec3::Zero();
  double last_ = 0.0;
};

/// The first offered body that Tandem shares; otherwise a ball, which each twin gets.
btRigidBody* shareOne(Site& site, ExampleHost& host) {
  for (btRigidBody* body : host.offered()) {
    try {
      site.share(*body);
      return body;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("a shared object must have a convex shape"),
                std::string::npos)
          << error.what();
    }
  }
  return nullptr;
}

/// Energy of a scene since its start [J].
struct EnergyBook {
  double start = 0.0, last = 0.0;
  double gained = 0.0;   ///< sum of all rises: Bullet's motors, springs and corrections
  double largest = 0.0;  ///< largest change

  explicit EnergyBook(double now) : start(now), last(now) {}
  void enter(double now) {
    gained += std::max(0.0, now - last);
    last = now;
    largest = std::max(largest, std::abs(now - start));
  }
};

// How much Bullet's joints, motors and contacts give depends on the motion, which the hand changes.
// So a fifth of what was exchanged is left to them. A body that is thrown exceeds that by far.
void expectNoEnergyButTheHands(const ExampleScene& scene, const Vec3& hand_offset_W) {
  ExampleHost bare, host;
  scene.build(bare);
  scene.build(host);
  PokingHand hand;
  SiteSettings settings;
  settings.peers = 1;  // the body keeps its mass, as in the twin
  settings.contact = {1000.0, 1.0};
  settings.passivity.enabled = false;  // the hand feels and gives all that the island renders
  settings.max_slew = std::numeric_limits<double>::infinity();
  Site site(settings, host.world(), hand);
  btRigidBody* shared = shareOne(site, host);
  if (!shared) {
    bare.addGuest();
    shared = &host.addGuest();
    site.share(*shared);
  }
  hand.putTo(fromBullet(shared->getCenterOfMassPosition()) + Vec3(0.0, 0.0, 0.3) + hand_offset_W);
  EnergyBook twin(bare.energy());
  double excess = -std::numeric_limits<double>::infinity();
  const int steps = countSteps(host, std::min(scene.duration, 4.0));
  for (int i = 0; i < steps; ++i) {
    const double time = i * host.dt;
    hand.goal_W = fromBullet(shared->getCenterOfMassPosition()) +
                  Vec3(0.3 * std::sin(3.0 * time), 0.2 * std::cos(2.0 * time), 0.0);
    bare.step();
    host.step();
    twin.enter(bare.energy());
    const double rise = host.energy() - twin.start;
    ASSERT_TRUE(std::isfinite(rise)) << "after step " << i + 1;
    excess = std::max(excess, rise - twin.gained - hand.most_given);
  }
  const double rounding = 1e-6 * (1.0 + std::abs(twin.start));
  if (scene.bounds_energy) {
    EXPECT_LE(excess, 0.2 * (twin.largest + hand.most_given) + rounding);
  }
  EXPECT_TRUE(isFinite(site.object(0)));
  EXPECT_EQ(site.status() & ~kOutOfRange, 0u);  // some scenes have no floor
}

TEST_P(BulletsExample, GetsNoEnergyButTheHands) {
  expectNoEnergyButTheHands(GetParam(), Vec3::Zero());
}

// A falling pile meets the floor: neighbours come in the step in which Bullet stops others. Where
// these stood before must not look like a speed. A fifth of the starts threw boxes at 80 m/s.
TEST(BulletsPile, GetsNoEnergyWhereverTheHandStarts) {
  const std::vector<ExampleScene> scenes = test::exampleScenes();
  const auto pile = std::find_if(scenes.begin(), scenes.end(), [](const ExampleScene& scene) {
    return std::string(scene.name) == "BasicExample";
  });
  ASSERT_NE(pile, scenes.end());
  for (const double x : {0.01, 0.02, 0.03, -0.02}) {
    SCOPED_TRACE(x);
    expectNoEnergyButTheHands(*pile, Vec3(x, 0.0, 0.0));
  }
}

INSTANTIATE_TEST_SUITE_P(All, BulletsExample, ::testing::ValuesIn(test::exampleScenes()),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace tandem
