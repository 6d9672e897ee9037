#pragma once

class btDiscreteDynamicsWorld;

namespace tandem {

/// Who is told that a world ends.
class WorldEndListener {
 public:
  virtual void worldEnds() noexcept = 0;

 protected:
  ~WorldEndListener() = default;
};

/// An island manager that stands in for a world's own.
class IslandManagerStandIn;

/// Notices that a host destroys its world.
///
/// Bullet tells nobody. But a world owns its island manager and destroys it first of all, by a
/// virtual call, with its bodies and its broadphase still there. So one of ours stands in for it,
/// made of the same class and doing the same to the bit. A world whose manager is not one of
/// Bullet's two cannot be watched.
class WorldEndWatch {
 public:
  WorldEndWatch(btDiscreteDynamicsWorld& world, WorldEndListener& listener);
  /// Puts the world's own manager back, if the world still stands. If somebody has put another one
  /// on top, ours stays below it and is silent.
  ~WorldEndWatch();
  WorldEndWatch(const WorldEndWatch&) = delete;
  WorldEndWatch& operator=(const WorldEndWatch&) = delete;

  [[nodiscard]] bool isWatching() const noexcept { return stand_in_ != nullptr; }

 private:
  friend class IslandManagerStandIn;

  btDiscreteDynamicsWorld& world_;
  WorldEndListener& listener_;
  IslandManagerStandIn* stand_in_ = nullptr;  // the world's, and gone with it
};

}  // namespace tandem
