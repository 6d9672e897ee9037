#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "tandem/bullet_bridge/convert.h"
#include "tandem/plugin/site.h"

#include "bench/accuracy/comparison.h"
#include "bench/methods/bullet_scene.h"
#include "bench/methods/tool_scheme.h"
#include "bench/reference/planar_reference.h"
#include "support/fakes.h"

/// \file
/// Runs bench scenes with the site's ticks on one time line and the host's steps on another:
///
///     island  |--------|--------|--------|--------|--------|   ticks of 1 ms
///     host             [0 .. T] comes here or later            its step, simulated at once
namespace tandem::test {

using namespace demos::bench;  // NOLINT: scenes and their reference

/// Times of the host's steps. Step n simulates [n T, (n + 1) T]; a punctual one comes at (n + 1) T.
struct HostTiming {
  int rate = 60;              ///< 1 / T [Hz]
  double late = 0.0;          ///< lateness of each step [s]
  double jitter = 0.0;        ///< extra random lateness, up to this [s]
  unsigned seed = 1;          ///< seed of the jitter
  double stall_at = 1e9;      ///< steps due in the stall come at its end [s]
  double stall = 0.0;         ///< length of the stall [s]
  double known_stall = -1.0;  ///< SiteSettings::host_stall; negative: stall and jitter together
};

/// A bench scene run by a site whose host steps at any time.
class LateHost {
 public:
  LateHost(const BenchScene& scene, const HostTiming& timing, SiteSettings settings = {})
      : scene_(scene),
        timing_(timing),
        period_(1.0 / timing.rate),
        random_(timing.seed),
        bullet_(scene, {.has_tools = false, .keeps_plane = false, .shared_mass_factor = 2}),
        scheme_(scene),
        links_(scene.tools.size()) {
    settings.host_step = period_;
    settings.contact = scene.contact;
    settings.packet_rate = 1000.0;
    settings.coordination = {0.0, 0.0};
    if (!scene.tools.empty())
      settings.proxy = {scene.tools.front().mass, 0.0, scene.tools.front().radius};
    settings.scheme = &scheme_;
    settings.tick_source = TickSource::kCaller;
    settings.host_stall =
        timing.known_stall >= 0.0 ? timing.known_stall : timing.stall + timing.jitter + timing.late;
    site_ = std::make_unique<Site>(settings, bullet_.world(), device_);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      if (scene.bodies[b].is_shared) site_->share(bullet_.body(b));
    for (std::size_t i = 0; i < scene.tools.size(); ++i) {
      site_->connect(PeerId{static_cast<std::uint32_t>(i) + 2}, links_[i],
                     scene.tools[i].start.p_W);
      proxy(i).setLinearVelocity(toBullet(scene.tools[i].start.v_W));
    }
    chooseNextCall();
  }

  /// Runs to the scene's end. Calls `each_tick` before each tick, `each_step` after each host step.
  template <typename EachTick, typename EachStep>
  void run(double duration, EachTick each_tick, EachStep each_step) {
    const auto end = static_cast<std::uint64_t>(std::llround(duration * kTargetRate));
    while (site_->tickCount() < end) {
      const double now = time();
      each_tick();
      setTargets(now);
      site_->tick(now);
      while (next_call_ <= time() + 1e-9) {
        bullet_.world().stepSimulation(static_cast<btScalar>(period_), 0);
        ++steps_;
        chooseNextCall();
        each_step();
      }
    }
  }

  [[nodiscard]] double time() const {
    return static_cast<double>(site_->tickCount()) / kTargetRate;
  }
  [[nodiscard]] double hostTime() const { return static_cast<double>(steps_) * period_; }
  [[nodiscard]] Site& site() { return *site_; }
  [[nodiscard]] BulletScene& bullet() { return bullet_; }
  [[nodiscard]] btRigidBody& proxy(std::size_t i) { return *site_->proxyBody(static_cast<int>(i)); }
  void endSite() { site_.reset(); }

  /// State of the bodies in the host's world.
  [[nodiscard]] SceneState hostState() {
    SceneState state = startState(scene_);
    bullet_.read(state);
    for (std::size_t i = 0; i < state.tools.size(); ++i) state.tools[i] = pointOf(proxy(i));
    return state;
  }

 private:
  void setTargets(double now) {
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const auto target = heldTarget(scene_.tools[i], now);
      if (!target) continue;
      StatePacket packet;
      packet.sender = PeerId{static_cast<std::uint32_t>(i) + 2};
      packet.sequence = site_->tickCount();
      packet.user = *target;
      links_[i].arrivals.push_back({packet, now});
    }
  }

  void chooseNextCall() {
    const double random = static_cast<double>(random_()) / static_cast<double>(random_.max());
    const double due =
        (static_cast<double>(steps_) + 1.0) * period_ + timing_.late + timing_.jitter * random;
    const double stall_end = timing_.stall_at + timing_.stall;
    const bool in_stall = due > timing_.stall_at && due < stall_end;
    next_call_ = std::max(next_call_, in_stall ? stall_end : due);
  }

  const BenchScene& scene_;
  HostTiming timing_;
  double period_;
  std::mt19937_64 random_;
  BulletScene bullet_;
  ToolScheme scheme_;
  test::FakeDevice device_{Vec3(0.0, 10.0, 10.0)};
  std::vector<test::FakeLink> links_;
  std::unique_ptr<Site> site_;
  std::uint64_t steps_ = 0;
  double next_call_ = 0.0;
};

/// Largest differences to the reference: tools at each tick, bodies at the ends of host steps.
inline RunErrors compareLate(LateHost& host, const BenchScene& scene,
                             const ReferenceRun& reference) {
  RunErrors errors;
  const auto at = [&](double time) {
    const auto n = static_cast<std::size_t>(std::llround(time * kGridRate));
    return reference.states[std::min(n, reference.states.size() - 1)];
  };
  host.run(
      scene.duration,
      [&] {
        SceneState state = at(host.time());
        const SceneState truth = state;
        for (std::size_t i = 0; i < state.tools.size(); ++i)
          state.tools[i] = host.site().proxy(static_cast<int>(i))->point();
        errors.include(compareStates(scene, state, truth));
      },
      [&] {
        SceneState state = host.hostState();
        const SceneState truth = at(host.hostTime());
        state.tools = truth.tools;
        errors.include(compareStates(scene, state, truth));
      });
  return errors;
}

}  // namespace tandem::test
