#pragma once

class btDiscreteDynamicsWorld;

#include "tandem/bullet_bridge/bullet_abi.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Who is told about each step of a host's world (each sub-step of a stepSimulation call).
class HostStepListener {
 public:
  virtual ~HostStepListener() = default;
  virtual void beforeHostStep(double dt) noexcept = 0;  ///< pre-tick; `dt` of this sub-step [s]
  virtual void afterHostStep(double dt) noexcept = 0;   ///< post-tick, poses are new
};

/// Holds on to a host's Bullet world by its pre-tick and post-tick callbacks.
///
/// Bullet has one slot for each and one user pointer for both; the host may need all three. So the
/// host's callbacks are called before ours in the pre-tick and after ours in the post-tick, with
/// the world's user pointer untouched, and are put back on destruction if we are still on top (else
/// we stay as a silent link of the chain that only calls through). A second HostWorld on the same
/// world throws tandem::Error. Worlds may live in different threads; one world is attached, stepped
/// and detached from one thread. The world must outlive this object.
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

 private:
  btDiscreteDynamicsWorld& world_;
};

}  // namespace tandem
#pragma GCC visibility pop
