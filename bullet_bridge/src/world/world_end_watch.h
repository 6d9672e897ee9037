#pragma once

class btDiscreteDynamicsWorld;

namespace tandem {

/// Listener for the end of a world.
class WorldEndListener {
 public:
  virtual void worldEnds() noexcept = 0;

 protected:
  ~WorldEndListener() = default;
};

/// An island manager that replaces a world's own.
class IslandManagerStandIn;

/// Notices that a host destroys its world.
///
/// Bullet has no callback for it. But a world owns its island manager and destroys it first, by a
/// virtual call, while bodies and broadphase still exist. A stand-in of the same class replaces it
/// and behaves the same to the bit. A world whose manager is not one of Bullet's two cannot be
/// watched.
class WorldEndWatch {
 public:
  WorldEndWatch(btDiscreteDynamicsWorld& world, WorldEndListener& listener);
  /// Restores the world's own manager if the world still exists. If another one was set since, ours
  /// stays below it and is silent.
  ~WorldEndWatch();
  WorldEndWatch(const WorldEndWatch&) = delete;
  WorldEndWatch& operator=(const WorldEndWatch&) = delete;

  [[nodiscard]] bool isWatching() const noexcept { return stand_in_ != nullptr; }

 private:
  friend class IslandManagerStandIn;

  btDiscreteDynamicsWorld& world_;
  WorldEndListener& listener_;
  IslandManagerStandIn* stand_in_ = nullptr;  // owned by the world, destroyed with it
};

}  // namespace tandem
