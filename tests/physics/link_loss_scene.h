#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "tandem/coordination/scheme.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

/// \file
/// Two sites in virtual time whose network is cut for a while. The hands follow fixed paths,
/// whatever force they feel.
namespace tandem::test {

/// Motion of the hands.
enum class Phase {
  kFree,     ///< the hands move in free space
  kPushing,  ///< the first pushes the cube along, the second is far away
  kHolding,  ///< they press the cube between them
  kMeeting,  ///< the hands press against each other
};

struct OutageCase {
  std::string scheme = "remote_dynamic_proxy";
  Phase phase = Phase::kFree;
  bool is_guided = true;
  double outage = 0.0;  ///< duration of the cut [s]
};

/// One direction of a network with a constant delay.
class CutLink final : public Link {
 public:
  CutLink(double delay, double cut_from, double cut_until)
      : delay_(delay), cut_from_(cut_from), cut_until_(cut_until) {}
  void connect(CutLink& other) { other_ = &other; }
  void send(const StatePacket& packet, double now) noexcept override {
    if (now >= cut_from_ && now < cut_until_) return;
    other_->arrivals_.push_back({packet, now + delay_});
  }
  [[nodiscard]] std::optional<Arrival> receive(double, double until) noexcept override {
    if (arrivals_.empty() || arrivals_.front().time >= until) return std::nullopt;
    const Arrival arrival = arrivals_.front();
    arrivals_.pop_front();
    return arrival;
  }

 private:
  double delay_, cut_from_, cut_until_;
  CutLink* other_ = nullptr;
  std::deque<Arrival> arrivals_;
};

struct OutageRun {
  static constexpr double kPeriod = 1e-3, kHostStep = 4e-3, kDelay = 0.02;
  static constexpr double kCutFrom = 1.0, kAfter = 2.0;  ///< [s]
  static constexpr double kHalf = 0.02, kRadius = 0.01;
  static constexpr double kPress = 8e-4;      ///< depth of the hands in what they press [m]
  static constexpr double kPushSpeed = 0.02;  ///< [m/s]
  static constexpr double kObjectDamping = 4.0;

  explicit OutageRun(const OutageCase& wanted) : c(wanted) {
    for (std::size_t i = 0; i < 2; ++i) {
      links[i] = std::make_unique<CutLink>(kDelay, kCutFrom, kCutFrom + c.outage);
      devices[i] = test::FakeDevice(hand(i, 0.0).p_W);
    }
    links[0]->connect(*links[1]);
    links[1]->connect(*links[0]);
    for (std::size_t i = 0; i < 2; ++i) {
      SiteSettings settings;
      settings.self = PeerId{static_cast<std::uint32_t>(i) + 1};
      settings.tick_source = TickSource::kCaller;
      settings.host_step = kHostStep;
      settings.thins_when_idle = false;  // age limits are those of the full rate
      settings.scheme = &findScheme(c.scheme);
      if (c.is_guided) settings.guide = Vec3(1, 0, 0);
      sites[i] = std::make_unique<Site>(settings, rigs[i].world, devices[i]);
      if (c.phase != Phase::kMeeting)
        sites[i]->share(rigs[i].addCube(0.2, kHalf, Vec3::Zero()), kObjectDamping);
      sites[i]->connect(PeerId{static_cast<std::uint32_t>(2 - i)}, *links[i], hand(1 - i, 0.0).p_W);
    }
  }
  ~OutageRun() {
    for (auto& site : sites) site.reset();
  }

  void run() {
    const auto count = static_cast<int>(std::lround((kCutFrom + c.outage + kAfter) / kPeriod));
    for (int tick = 0; tick < count; ++tick) {
      const double now = tick * kPeriod;
      for (std::size_t i = 0; i < 2; ++i) {
        devices[i].sample.hip = hand(i, now);
        status |= sites[i]->tick(now);
        forces[i].push_back(sites[i]->force().x());
        states[i].push_back(sites[i]->linkState(0));
        if (tick % 4 == 3) rigs[i].step(kHostStep);
      }
    }
  }

  /// State of hand `i` at time `t`.
  [[nodiscard]] PointState hand(std::size_t i, double t) const {
    const double side = i == 0 ? -1.0 : 1.0;
    PointState state;
    if (c.phase == Phase::kFree || (c.phase == Phase::kPushing && i == 1)) {
      state.p_W.x() = side * (0.3 + 0.01 * std::sin(6.0 * t));
      state.v_W.x() = side * 0.06 * std::cos(6.0 * t);
      return state;
    }
    // The hand approaches smoothly from 4 mm away.
    constexpr double kComing = 0.3, kWay = 4e-3 + kPress, kPi = 3.14159265358979323846;
    const double touch = kRadius + (c.phase == Phase::kMeeting ? 0.0 : kHalf);
    const double s = std::min(t / kComing, 1.0);
    state.p_W.x() = side * (touch + 4e-3 - kWay * 0.5 * (1.0 - std::cos(kPi * s)));
    state.v_W.x() = s < 1.0 ? -side * kWay * 0.5 * kPi / kComing * std::sin(kPi * s) : 0.0;
    if (c.phase == Phase::kPushing && t > kComing) {
      // The hand goes from rest to its speed in 0.2 s.
      const double since = t - kComing, ramp = std::min(since / 0.2, 1.0);
      state.v_W.x() = kPushSpeed * ramp;
      state.p_W.x() += kPushSpeed * (since < 0.2 ? 2.5 * since * since : since - 0.1);
    }
    return state;
  }

  /// Largest change of a device's force from one tick to the next [N].
  [[nodiscard]] double largestStep() const {
    double most = 0.0;
    for (const auto& f : forces)
      for (std::size_t k = 1; k < f.size(); ++k) most = std::max(most, std::abs(f[k] - f[k - 1]));
    return most;
  }
  [[nodiscard]] double largestForce() const {
    double most = 0.0;
    for (const auto& f : forces)
      for (const double value : f) most = std::max(most, std::abs(value));
    return most;
  }
  [[nodiscard]] static std::size_t tickAt(double time) {
    return static_cast<std::size_t>(std::lround(time / kPeriod));
  }

  OutageCase c;
  std::array<BulletRig, 2> rigs;
  std::array<test::FakeDevice, 2> devices;
  std::array<std::unique_ptr<CutLink>, 2> links;
  std::array<std::unique_ptr<Site>, 2> sites;
  std::array<std::vector<double>, 2> forces;
  std::array<std::vector<LinkState>, 2> states;
  std::uint32_t status = kTickOk;
};

}  // namespace tandem::test
