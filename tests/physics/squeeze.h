#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "tandem/coordination/scheme.h"
#include "tandem/coordination/simulated_link.h"
#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"

namespace tandem::test {

/// Describes a Squeeze.
struct SqueezeCase {
  std::string scheme = "remote_dynamic_proxy";
  CoordinationMode mode = CoordinationMode::kAverage;
  int sites = 2;
  double delay = 0.02;  ///< one way [s]
  bool is_guided = true;
};

/// N users press a cube along x from both sides, in virtual time: odd ones from -x, even ones from
/// +x, side by side. Each of them holds the device with 300 N/m and 5 N s/m. Without a guide,
/// factors of Bullet keep the cube from sliding out between the hands.
class Squeeze {
 public:
  static constexpr double kHalf = 0.035, kRadius = 0.01, kPeriod = 1e-3, kHostStep = 4e-3;
  static constexpr double kStiffness = 300.0, kDamping = 5.0;  ///< of a hand
  static constexpr double kComing = 1.5, kWay = 8e-3;          ///< of a hand into the cube [s], [m]

  explicit Squeeze(const SqueezeCase& wanted) : case_(wanted) {
    for (int i = 0; i < case_.sites; ++i) users_.push_back(makeUser(i));
    for (int i = 0; i < case_.sites; ++i)
      for (int k = i + 1; k < case_.sites; ++k) connect(i, k);
  }

  /// Pushes the first user's device at once by `impulse_W` [N s].
  void nudge(const Vec3& impulse_W) { user(0).push->f_W = impulse_W / kPeriod; }

  void runUntil(double time) {
    for (; ticks_ < std::lround(time / kPeriod); ++ticks_) {
      const double now = static_cast<double>(ticks_) * kPeriod;
      for (auto& user : users_) status_ |= user->site->tick(now);
      user(0).push->f_W.setZero();
      if (ticks_ % 4 != 3) continue;
      for (auto& user : users_) user->rig.step(kHostStep);
    }
  }

  /// Largest speed along x of a copy and of a device within `time` [s] from now [m/s].
  [[nodiscard]] double findFastest(double time) {
    double fastest = 0.0;
    const double end = static_cast<double>(ticks_) * kPeriod + time;
    for (double now = static_cast<double>(ticks_) * kPeriod; now < end; now += kPeriod) {
      runUntil(now + kPeriod);
      for (auto& user : users_) {
        fastest = std::max(fastest, std::abs(user->site->object(0).v_W.x()));
        const double hand = user->device->read(now + kPeriod).hip.v_W.x();
        fastest = std::max(fastest, std::abs(hand));
      }
    }
    return fastest;
  }

  [[nodiscard]] std::uint32_t status() const { return status_; }
  [[nodiscard]] Site& site(int i) { return *user(i).site; }

 private:
  /// A held hand that is pushed now and then.
  struct PushedHand final : Hand {
    explicit PushedHand(std::unique_ptr<Hand> hand) : holding(std::move(hand)) {}
    [[nodiscard]] Vec3 computeForce(double t, const PointState& handle) const noexcept override {
      return holding->computeForce(t, handle) + f_W;
    }
    std::unique_ptr<Hand> holding;
    Vec3 f_W = Vec3::Zero();
  };
  struct User {
    ~User() { site.reset(); }
    BulletRig rig;
    PushedHand* push = nullptr;
    std::unique_ptr<SimulatedDevice> device;
    std::unique_ptr<Site> site;
  };

  [[nodiscard]] User& user(int i) { return *users_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] static PeerId idOf(int i) { return PeerId{static_cast<std::uint32_t>(i) + 1}; }

  /// Just in contact. Two users take the centre, more a grid of three by three.
  [[nodiscard]] Vec3 startOf(int i) const {
    const double side = i % 2 == 0 ? -1.0 : 1.0;
    Vec3 start_W(side * (kHalf + kRadius), 0.0, 0.0);
    if (case_.sites < 3) return start_W;
    const int place = (i / 2 + 4) % 9;  // the first stands in the centre
    start_W.y() = 2.1 * kRadius * (place % 3 - 1);
    start_W.z() = 2.1 * kRadius * (place / 3 - 1);
    return start_W;
  }

  [[nodiscard]] std::unique_ptr<User> makeUser(int i) const {
    auto user = std::make_unique<User>();
    const Vec3 start_W = startOf(i);
    const Vec3 inside_W = start_W + Vec3(i % 2 == 0 ? kWay : -kWay, 0.0, 0.0);
    auto hand = std::make_unique<PushedHand>(
        makeMinimumJerkHand({{0.0, start_W}, {kComing, inside_W}}, kStiffness, kDamping));
    user->push = hand.get();
    SimulatedDeviceSettings device;
    device.start_W = start_W;
    if (case_.is_guided) device.guide = Vec3(1, 0, 0);
    user->device = std::make_unique<SimulatedDevice>(device, std::move(hand));
    SiteSettings settings;
    settings.self = idOf(i);
    settings.peers = case_.sites;
    settings.coordination_mode = case_.mode;
    settings.scheme = &findScheme(case_.scheme);
    settings.tick_source = TickSource::kCaller;
    settings.host_step = kHostStep;
    settings.thins_when_idle = false;
    settings.passivity.enabled = false;  // the couplers alone have to be stable
    if (case_.is_guided) settings.guide = Vec3(1, 0, 0);
    user->site = std::make_unique<Site>(settings, user->rig.world, *user->device);
    btRigidBody& cube = user->rig.addCube(0.1 * case_.sites, kHalf);
    cube.setLinearFactor(btVector3(1, 0, 0));
    cube.setAngularFactor(0);
    user->site->share(cube);
    return user;
  }

  void connect(int i, int k) {
    auto [one, other] = makeSimulatedLinks({case_.delay});
    user(i).site->connect(idOf(k), *one, startOf(k));
    user(k).site->connect(idOf(i), *other, startOf(i));
    links_.push_back(std::move(one));
    links_.push_back(std::move(other));
  }

  SqueezeCase case_;
  std::vector<std::unique_ptr<SimulatedLink>> links_;
  std::vector<std::unique_ptr<User>> users_;
  long ticks_ = 0;
  std::uint32_t status_ = 0;
};

}  // namespace tandem::test
