#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/bullet_bridge/bullet_abi.h"

class btDiscreteDynamicsWorld;

#pragma GCC visibility push(default)
namespace tandem {

/// Listener for each step of a host's world (each sub-step of a stepSimulation call).
class HostStepListener {
 public:
  virtual ~HostStepListener() = default;
  virtual void beforeHostStep(double dt) noexcept = 0;  ///< pre-tick; `dt` of this sub-step [s]
  /// Post-tick: poses are new. Called only if beforeHostStep() was called for this step.
  virtual void afterHostStep(double dt) noexcept = 0;
  /// The host is destroying its world. Bodies, broadphase and dispatcher still exist during this
  /// call; do not touch them afterwards.
  virtual void hostWorldEnds() noexcept {}
};

/// Attaches to a host's Bullet world by its pre-tick and post-tick callbacks.
///
/// Bullet has one slot for each and one user pointer for both; the host may need all three. The
/// host's callbacks run before ours in the pre-tick and after ours in the post-tick, with the
/// world's user pointer unchanged. Destruction restores them if we are still on top; else a silent
/// link remains that only calls through. A second HostWorld on the same world throws tandem::Error.
/// Worlds may live in different threads; one world is attached, stepped and detached in one thread.
/// Attaching and detaching may happen within a step, in the host's own tick callbacks. A new
/// listener hears of the next whole step first, a detached one of none.
///
/// The world should outlive this object. If not, hostWorldEnds() is called and this object stays
/// idle. With an island manager of the host's own the end goes unnoticed; see warnings().
class HostWorld {
 public:
  /// Throws tandem::Error if the world is attached already, or if the Bullet builds of host and
  /// library differ.
  HostWorld(btDiscreteDynamicsWorld& world, HostStepListener& listener,
            BulletAbi host = bulletAbiOfThisCode());
  ~HostWorld();
  HostWorld(const HostWorld&) = delete;
  HostWorld& operator=(const HostWorld&) = delete;

  [[nodiscard]] btDiscreteDynamicsWorld& world() const noexcept { return world_; }
  /// True once the host has destroyed its world.
  [[nodiscard]] bool hasEnded() const noexcept;
  /// Warnings for the user about the world, one line each.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  btDiscreteDynamicsWorld& world_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
