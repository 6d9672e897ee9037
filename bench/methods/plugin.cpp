// The plugin as a host uses it: a Bullet world, a site, and the scene's tools as remote dynamic
// proxies. Packets of their remote users come every millisecond without delay.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tandem/bullet_bridge/convert.h"
#include "tandem/plugin/recording.h"
#include "tandem/plugin/site.h"

#include "bench/methods/all_methods.h"
#include "bench/methods/bullet_scene.h"
#include "bench/methods/tool_scheme.h"

namespace tandem::demos::bench {
namespace {

/// Peers that carry a shared object: this one and a remote. The host's body then has twice the
/// scene's mass, and the plugin leaves it the scene's.
constexpr int kPeers = 2;

/// The local user's device, far from all bodies: the scene's users are all remote.
class ParkedDevice final : public HapticDevice {
 public:
  const DeviceCapabilities& capabilities() const noexcept override { return capabilities_; }
  DeviceSample read(double) noexcept override { return {{Vec3(0, 10, 10), Vec3::Zero()}, true}; }
  void write(const Vec3&) noexcept override {}

 private:
  DeviceCapabilities capabilities_;
};

/// A remote user who moves along a tool's path and sends once per millisecond, without delay.
class HeldPathLink final : public Link {
 public:
  HeldPathLink(const BenchTool& tool, PeerId user) : tool_(tool) { packet_.sender = user; }

  void send(const StatePacket&, double) noexcept override {}
  std::optional<Arrival> receive(double from, double) noexcept override {
    const auto millisecond = static_cast<std::uint64_t>(from * kTargetRate + 1e-6);
    const auto target = heldTarget(tool_, from);
    if (millisecond < next_ || !target) return std::nullopt;
    next_ = millisecond + 1;
    packet_.sequence = millisecond;
    packet_.time = from;
    packet_.user = *target;
    return Arrival{packet_, from};
  }

 private:
  const BenchTool& tool_;
  std::uint64_t next_ = 0;
  StatePacket packet_;
};

enum class Variant { kHandoff, kLate, kImpulse };

SiteSettings makeSettings(const BenchScene& scene, int host_rate, Variant variant,
                          const Scheme& scheme) {
  SiteSettings settings;
  settings.peers = kPeers;
  settings.haptic_rate = variant == Variant::kImpulse ? host_rate : kTargetRate;
  settings.packet_rate = std::min<double>(kTargetRate, settings.haptic_rate);
  settings.host_step = 1.0 / host_rate;
  settings.contact = scene.contact;
  settings.coordination = {0.0, 0.0};
  settings.proxy = {scene.tools.front().mass, 0.0, scene.tools.front().radius};
  settings.scheme = &scheme;
  settings.injection = variant == Variant::kImpulse ? Injection::kImpulse : Injection::kHandoff;
  // Every body of a pile may be near.
  settings.max_neighbours =
      std::max(settings.max_neighbours, static_cast<int>(scene.bodies.size()));
  // Tests the law, not the guards.
  settings.max_slew = settings.max_peer_speed = std::numeric_limits<double>::infinity();
  settings.tick_source = variant == Variant::kLate ? TickSource::kCaller : TickSource::kHostStep;
  return settings;
}

class PluginSimulation final : public Simulation {
 public:
  PluginSimulation(const BenchScene& scene, int host_rate, Variant variant)
      : scene_(scene),
        variant_(variant),
        step_(1.0 / host_rate),
        bullet_(scene, {.has_tools = false,
                        .keeps_plane = variant == Variant::kImpulse,
                        .shared_mass_factor = kPeers}),
        scheme_(scene),
        site_(makeSettings(scene, host_rate, variant, scheme_), bullet_.world(), device_) {
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      if (scene.bodies[b].is_shared) site_.share(bullet_.body(b));
    links_.reserve(scene.tools.size());
    for (std::size_t i = 0; i < scene.tools.size(); ++i) {
      const PeerId user{static_cast<std::uint32_t>(i) + 2};
      links_.emplace_back(scene.tools[i], user);
      site_.connect(user, links_.back(), scene.tools[i].start.p_W);
      proxy(i).setLinearVelocity(toBullet(scene.tools[i].start.v_W));
    }
  }

  void step() override {
    // The late caller's ticks are one host period ahead of the world.
    if (variant_ == Variant::kLate) tickUntil((steps_ + 2) * step_);
    for (std::size_t i = 0; i < scene_.tools.size(); ++i)
      proxy(i).applyCentralForce(toBullet(scene_.tools[i].f_W));
    bullet_.step(step_);
    ++steps_;
  }

  void read(SceneState& state) const override {
    bullet_.read(state);
    for (std::size_t i = 0; i < scene_.tools.size(); ++i) state.tools[i] = pointOf(proxy(i));
  }

  void keepTicks() override {
    // Impulse injection has only Bullet's states, at the ends of its steps.
    if (variant_ == Variant::kImpulse) return;
    const auto ticks = static_cast<std::size_t>((scene_.duration + 2.0 * step_) * kTargetRate) + 2;
    recording_.emplace(ticks, ticks * scene_.tools.size(), site_.objectCount(),
                       static_cast<int>(scene_.tools.size()));
    site_.record(&*recording_);
  }

  std::vector<TickSample> tickSamples() const override {
    std::vector<TickSample> samples;
    if (!recording_) return samples;
    for (std::size_t tick = 0; tick < recording_->ticks().size(); ++tick)
      for (int i = 0; i < recording_->proxyCount(); ++i)
        samples.push_back({tick, i, recording_->proxy(tick, i).island.point()});
    return samples;
  }

 private:
  btRigidBody& proxy(std::size_t i) const { return *site_.proxyBody(static_cast<int>(i)); }

  void tickUntil(double time) {
    while (static_cast<double>(site_.tickCount()) / kTargetRate < time - 1e-9)
      site_.tick(static_cast<double>(site_.tickCount()) / kTargetRate);
  }

  const BenchScene& scene_;
  Variant variant_;
  double step_;
  double steps_ = 0;
  BulletScene bullet_;
  ToolScheme scheme_;
  ParkedDevice device_;
  std::vector<HeldPathLink> links_;
  std::optional<Recording> recording_;
  Site site_;
};

bool isMovedByHost(const BenchTool& tool) {
  return tool.f_W != Vec3::Zero() || tool.start.v_W != Vec3::Zero();
}

class PluginMethod final : public Method {
 public:
  PluginMethod(std::string name, Variant variant) : name_(std::move(name)), variant_(variant) {}
  std::string name() const override { return name_; }

  std::unique_ptr<Simulation> start(const BenchScene& scene, int host_rate) const override {
    if (variant_ == Variant::kLate &&
        std::any_of(scene.tools.begin(), scene.tools.end(), isMovedByHost))
      throw NotApplicable("what the host itself does to the tool reaches the island a step late");
    return std::make_unique<PluginSimulation>(scene, host_rate, variant_);
  }

 private:
  std::string name_;
  Variant variant_;
};

}  // namespace

std::unique_ptr<Method> makePluginHandoff() {
  return std::make_unique<PluginMethod>("plugin handoff", Variant::kHandoff);
}
std::unique_ptr<Method> makePluginLate() {
  return std::make_unique<PluginMethod>("plugin handoff, late", Variant::kLate);
}
std::unique_ptr<Method> makePluginImpulse() {
  return std::make_unique<PluginMethod>("plugin impulse", Variant::kImpulse);
}

}  // namespace tandem::demos::bench
