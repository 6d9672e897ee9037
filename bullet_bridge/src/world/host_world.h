#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/bullet_bridge/bullet_abi.h"

class btDiscreteDynamicsWorld;

#pragma GCC visibility push(default)
namespace tandem {

/// Who is told about each step of a host's world (each sub-step of a stepSimulation call).
class HostStepListener {
 public:
  virtual ~HostStepListener() = default;
  virtual void beforeHostStep(double dt) noexcept = 0;  ///< pre-tick; `dt` of this sub-step [s]
  /// Post-tick, poses are new. Only of a step whose beginning was told.
  virtual void afterHostStep(double dt) noexcept = 0;
  /// The host destroys its world, and nothing more will be heard of it: bodies in it, broadphase
  /// and dispatcher are still there in this call, and not to be touched after it.
  virtual void hostWorldEnds() noexcept {}
};

/// Holds on to a host's Bullet world by its pre-tick and post-tick callbacks.
///
/// Bullet has one slot for each and one user pointer for both; the host may need all three. So the
/// host's callbacks are called before ours in the pre-tick and after ours in the post-tick, with
/// the world's user pointer untouched, and are put back on destruction if we are still on top (else
/// we stay as a silent link of the chain that only calls through). A second HostWorld on the same
/// world throws tandem::Error. Worlds may live in different threads; one world is attached, stepped
/// and detached from one thread. Both may be done within a step, by the host's own tick callbacks:
/// the listener then hears of the next whole step first, and of none that it is gone for.
///
/// The world should outlive this object. If it does not, the listener is told (hostWorldEnds), and
/// this object does nothing more - unless the world has an island manager of the host's own making,
/// through which its end is noticed otherwise; see warnings().
class HostWorld {
 public:
  /// Throws tandem::Error if the world is attached already or the Bullet of host and library
  /// differ.
  HostWorld(btDiscreteDynamicsWorld& world, HostStepListener& listener,
            BulletAbi host = bulletAbiOfThisCode());
  ~HostWorld();
  HostWorld(const HostWorld&) = delete;
  HostWorld& operator=(const HostWorld&) = delete;

  [[nodiscard]] btDiscreteDynamicsWorld& world() const noexcept { return world_; }
  /// True once the host has destroyed its world.
  [[nodiscard]] bool hasEnded() const noexcept;
  /// One line each, about what a user should know of the world.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  btDiscreteDynamicsWorld& world_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
