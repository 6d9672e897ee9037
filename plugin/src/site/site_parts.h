#pragma once

#include "bullet_bridge/src/world/host_world.h"
#include "live/island_desk.h"
#include "site/grips.h"
#include "site/object_watch.h"
#include "site/packet_sender.h"
#include "site/press.h"
#include "site/rest.h"
#include "site/surroundings.h"

namespace tandem {

/// The parts of a site. Each owns its state. In a tick and in a host step, data flow from the first
/// part to the last.
struct SiteParts {
  SiteParts(const SiteSettings& settings, btDiscreteDynamicsWorld& world, HapticDevice& device,
            BulletAbi abi, HostStepListener& listener);
  SiteParts(const SiteParts&) = delete;
  SiteParts& operator=(const SiteParts&) = delete;
  virtual ~SiteParts() = default;

  /// Runs one haptic period from `now`. Moves over ticks that were left out, for at most
  /// `most_made_up` [s].
  virtual std::uint32_t tick(double now, double most_made_up) noexcept = 0;

  /// Runs the ticks that start before `time`.
  void runTicksUntil(double time) noexcept;
  /// Updates the host's clock for its step of `dt`, which has just begun.
  void followHostClock(double dt) noexcept;
  /// Where Bullet moves the bodies: begins epochs of objects that the host put elsewhere.
  void noteTeleports() noexcept;
  /// Passes a host step in which a body is missing: the hand still gets its fading force.
  void passStepWithout(double dt) noexcept;
  /// True if all bodies are in the host's world; stops the site if not.
  bool areBodiesPresent() noexcept;

  [[nodiscard]] bool ticksInHostStep() const noexcept {
    return settings.tick_source == TickSource::kHostStep;
  }
  /// True if nothing is shared and no peer is connected: only the hand exists.
  [[nodiscard]] bool isBare() const noexcept { return bodies.objects.empty() && peers.isEmpty(); }
  /// True if the island moves the bodies and hands them off to Bullet.
  [[nodiscard]] bool handsOff() const noexcept {
    return settings.contact_model == ContactModel::kIsland &&
           settings.injection == Injection::kHandoff;
  }

  const SiteSettings settings;
  SiteLog log;
  IslandDesk desk;  ///< runs the host thread's requests where ticks run
  HostWorld host_world;
  Island island;
  Timeline timeline;
  HostClock clock;
  Bodies bodies;
  LocalHand hand;
  HostForces forces;
  Peers peers;
  Grips grips;
  PacketSender sender;
  Surroundings surroundings;
  Press press;
  ObjectWatch objects;
  Rest rest;
};

/// The next tick moves over ticks that were left out, for at most this long [s].
inline constexpr double kMostMadeUp = 0.05;

}  // namespace tandem
