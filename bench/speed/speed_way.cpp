#include "bench/speed/speed_way.h"

#include <chrono>

#include "tandem/bullet_bridge/convert.h"

#include "bench/speed/speed_site.h"
#include "coordination/src/geometry/contact_geometry.h"
#include "coordination/src/island/virtual_coupler.h"

namespace tandem::demos::bench {
namespace {

constexpr double kHapticRate = 1000.0;                                     // [Hz]
constexpr CouplerGains kContact{4000.0, 1.0}, kCoordination{200.0, 30.0};  // a site's defaults
constexpr double kWarmUp = 0.2;                                            // simulated time [s]

using Clock = std::chrono::steady_clock;

double microsecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

/// Steps the whole world at the haptic rate. Our own geometry gives the contact of hand and proxy
/// with the cube. This and the proxy's coupler are impulses F dt before each step.
class WholeWorldRun final : public SpeedRun {
 public:
  explicit WholeWorldRun(const SpeedScene& scene)
      : scene_(scene),
        world_(scene, 1.0),
        cube_(*world_.cubes().front()),
        proxy_(world_.addProxy(remoteAt(scene, 0.0).p_W, isPressed(scene))) {
    // The forces below are the only contact of sphere and cube.
    proxy_.setIgnoreCollisionCheck(&cube_, true);
    cube_.setIgnoreCollisionCheck(&proxy_, true);
  }
  int hostRate() const override { return static_cast<int>(kHapticRate); }
  void step(SpeedTimes& times) override {
    const auto start = Clock::now();
    if (scene_.touch != SpeedTouch::kNothing) pushAndPull(++steps_ / kHapticRate);
    world_.step(1.0 / kHapticRate);
    times.host += microsecondsSince(start);
    ++times.host_steps;
  }

 private:
  void pushAndPull(double time) {
    push(handAt(scene_, time));
    if (!isPressed(scene_)) return;
    const PointState proxy{fromBullet(proxy_.getCenterOfMassPosition()),
                           fromBullet(proxy_.getLinearVelocity())};
    const Vec3 pull_W = computeCouplerForce(kCoordination, remoteAt(scene_, time), proxy);
    give(proxy_, pull_W + push(proxy));
  }
  /// Force of the cube on a sphere; the cube gets its opposite.
  Vec3 push(const PointState& sphere) {
    const Vec3 p_WB = fromBullet(cube_.getCenterOfMassPosition());
    const SphereContact contact =
        findSphereContact(sphere.p_W, kSpeedRadius, Box{Vec3::Constant(kSpeedHalfEdge)}, p_WB,
                          fromBullet(cube_.getOrientation()));
    const Vec3 lever_W = contact.p_W - p_WB;
    const Vec3 v_W = fromBullet(cube_.getVelocityInLocalPoint(toBullet(lever_W)));
    const double rate = -contact.n_W.dot(sphere.v_W - v_W);
    const Vec3 f_W = computeContactForce(kContact, -contact.gap, rate) * contact.n_W;
    cube_.applyImpulse(toBullet(Vec3(-f_W / kHapticRate)), toBullet(lever_W));
    return f_W;
  }
  static void give(btRigidBody& body, const Vec3& f_W) {
    body.applyCentralImpulse(toBullet(Vec3(f_W / kHapticRate)));
  }

  SpeedScene scene_;
  SpeedWorld world_;
  btRigidBody& cube_;
  btRigidBody& proxy_;
  double steps_ = 0;
};

class IslandRun final : public SpeedRun {
 public:
  explicit IslandRun(const SpeedScene& scene) : site_(scene) {}
  int hostRate() const override { return 60; }
  void step(SpeedTimes& times) override {
    const double end = (++steps_) / hostRate();
    auto start = Clock::now();
    times.tick_count += site_.tickUntil(end);
    times.ticks += microsecondsSince(start);
    start = Clock::now();
    site_.stepHost();
    times.host += microsecondsSince(start);
    ++times.host_steps;
  }

 private:
  SpeedSite site_;
  double steps_ = 0;
};

/// Bullet alone. The remote user's sphere exists, as a site would add it. Between steps the
/// processor does other work, as with a site: uncounted ticks of a site at rest in another world.
class BareRun final : public SpeedRun {
 public:
  BareRun(const SpeedScene& scene, int host_rate)
      : world_(scene, 1.0), host_rate_(host_rate), other_({}) {
    world_.addProxy(remoteAt(scene, 0.0).p_W, false);
  }
  int hostRate() const override { return host_rate_; }
  void step(SpeedTimes& times) override {
    other_.tickUntil((++steps_) / host_rate_);
    const auto start = Clock::now();
    world_.step(1.0 / host_rate_);
    times.host += microsecondsSince(start);
    ++times.host_steps;
  }

 private:
  SpeedWorld world_;
  int host_rate_;
  SpeedSite other_;
  double steps_ = 0;
};

std::unique_ptr<SpeedRun> makeRun(const SpeedScene& scene, SpeedWay way) {
  switch (way) {
    case SpeedWay::kBare60:
      return std::make_unique<BareRun>(scene, 60);
    case SpeedWay::kBare240:
      return std::make_unique<BareRun>(scene, 240);
    case SpeedWay::kWhole:
      return std::make_unique<WholeWorldRun>(scene);
    case SpeedWay::kIsland:
      break;
  }
  return std::make_unique<IslandRun>(scene);
}

}  // namespace

std::string nameOf(SpeedWay way) {
  switch (way) {
    case SpeedWay::kBare60:
      return "Bullet 60 Hz";
    case SpeedWay::kBare240:
      return "Bullet 240 Hz";
    case SpeedWay::kWhole:
      return "whole world 1 kHz";
    case SpeedWay::kIsland:
      break;
  }
  return "Bullet 60 Hz + island";
}

std::unique_ptr<SpeedRun> startSpeedRun(const SpeedScene& scene, SpeedWay way) {
  std::unique_ptr<SpeedRun> run = makeRun(scene, way);
  SpeedTimes untold;
  for (int i = 0; i < kWarmUp * run->hostRate(); ++i) run->step(untold);
  return run;
}

}  // namespace tandem::demos::bench
