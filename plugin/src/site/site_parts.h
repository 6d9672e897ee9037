#pragma once

#include "bullet_bridge/src/world/host_world.h"
#include "live/island_desk.h"
#include "site/packet_sender.h"
#include "site/rest.h"
#include "site/surroundings.h"

namespace tandem {

/// The parts of a site. Each owns its state; data flow through a tick and a host's step from the
/// first to the last.
struct SiteParts {
  SiteParts(const SiteSettings& settings, btDiscreteDynamicsWorld& world, HapticDevice& device,
            BulletAbi abi, HostStepListener& listener);
  SiteParts(const SiteParts&) = delete;
  SiteParts& operator=(const SiteParts&) = delete;
  virtual ~SiteParts() = default;

  /// One haptic period from `now`. Of ticks that were left out at most `most_made_up` is moved over
  /// [s].
  virtual std::uint32_t tick(double now, double most_made_up) noexcept = 0;

  /// Runs the ticks that start before `time`.
  void runTicksUntil(double time) noexcept;
  /// The host's clock for its step of `dt`, which has just begun.
  void followHostClock(double dt) noexcept;
  /// A step for which a body is missing: the hand still gets its fading force.
  void passStepWithout(double dt) noexcept;
  /// True if all bodies are in the host's world; raises kBodyMissing if not.
  bool areBodiesPresent() noexcept;

  [[nodiscard]] bool ticksInHostStep() const noexcept {
    return settings.tick_source == TickSource::kHostStep;
  }
  /// Nothing shared and nobody connected: a hand alone.
  [[nodiscard]] bool isBare() const noexcept { return bodies.objects.empty() && peers.isEmpty(); }
  /// The island moves the bodies, and Bullet gets them by hand-off.
  [[nodiscard]] bool handsOff() const noexcept {
    return settings.contact_model == ContactModel::kIsland &&
           settings.injection == Injection::kHandoff;
  }

  const SiteSettings settings;
  SiteLog log;
  IslandDesk desk;  ///< where the host's thread asks for what belongs to whoever ticks
  HostWorld host_world;
  Island island;
  Timeline timeline;
  HostClock clock;
  Bodies bodies;
  LocalHand hand;
  HostForces forces;
  Peers peers;
  PacketSender sender;
  Surroundings surroundings;
  Rest rest;
};

/// Ticks that were left out are moved over by the next one, for so long at the most [s].
inline constexpr double kMostMadeUp = 0.05;

}  // namespace tandem
