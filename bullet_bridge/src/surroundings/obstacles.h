#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "coordination/src/island/contact_finder.h"
#include "coordination/src/island/island.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

/// Rigid surroundings of the island's bodies: the static objects of a host's world near them, and
/// they themselves for each other. Found once per host step; their contacts are searched for at
/// each inner step of the island, by Bullet's narrowphase on private copies.
///
/// The private origin is near the first body, so that a float Bullet resolves tens of nanometres
/// anywhere. Friction, restitution and margins are those of the host's objects, as they were at the
/// last update(); rolling friction
/// and contact stiffness are not used. Simple shapes are copied as they are when they come near;
/// meshes, height fields, compounds and other shapes of the host's are shared: they must not change
/// while attached, and must live until the commit() after their object has left the world - with a
/// haptic thread until the end of the host's next step.
/// Native contact between an island body and a candidate, and among island bodies, is filtered in
/// the host's world meanwhile. Kinematic objects are no candidates: they can be bodies. Bullet's
/// global contact callbacks see the copies, too; they carry their originals' user pointers.
///
/// Two threads may share it. addBody(), removeBody(), addSphere() and search() are for the thread
/// that steps the host's world; nothing of what they find acts before commit(), which is for the
/// thread that ticks, as are nearSpheres(), lookAround() and find(), while the other waits.
/// Compounds of several shapes make Bullet allocate in every search of contacts; all others only at
/// first touch.
class Obstacles final : public ContactFinder {
 public:
  /// `host` must outlive this object or be forgotten by it (forgetWorld), bodies too unless they
  /// have left the world.
  explicit Obstacles(btDiscreteDynamicsWorld& host);
  ~Obstacles() override;

  /// Not in the tick. The island body `index` is `body` of the host's world. Throws tandem::Error
  /// if the index has a body already, or the body is static, or of a shape neither convex nor
  /// compound (kinematic ones: a plane). Two kinematic bodies do not meet.
  void addBody(BodyIndex index, btRigidBody& body);

  /// Not in the tick. The index is free again, and native contact is the host's.
  void removeBody(BodyIndex index);

  /// Not in the tick. The host's world ends: no body is held and nothing is near any more, after
  /// the commit().
  void forgetWorld();

  /// Set-up. A haptic sphere (device or proxy): obstacles near it are reported by nearSpheres().
  void addSphere(BodyIndex index, double radius);

  /// Once per host step, from the host's thread: finds the static objects within `margin` [m] of
  /// each dynamic body and sphere, given their states by index. May allocate when a new obstacle
  /// comes near; the first time that a mesh is near a sphere it takes some microseconds for each
  /// triangle. Returns whether anything has come, gone or moved: who rested on it should be
  /// woken. With `moves`, by index, it searches around those that move only, and keeps whatever it
  /// had found; call it without now and then.
  bool search(const std::vector<RigidState>& states, double margin,
              const std::vector<char>* moves = nullptr);

  /// What was added, removed and found acts from now on. Real-time safe. nearSpheres() is another
  /// vector then.
  void commit() noexcept;

  /// Both at once.
  bool update(const std::vector<RigidState>& states, double margin,
              const std::vector<char>* moves = nullptr) {
    const bool has_changed = search(states, margin, moves);
    commit();
    return has_changed;
  }

  /// Obstacles near the spheres whose shape the island knows itself: those of convertShape() and
  /// convertMesh(), also as children of compounds.
  [[nodiscard]] const std::vector<Obstacle>& nearSpheres() const noexcept;

  void lookAround(const std::vector<RigidState>& states, const std::vector<double>& reach,
                  std::vector<char>& awake, std::vector<char>& near) noexcept override;
  void find(const std::vector<RigidState>& states,
            std::vector<RigidContact>& contacts) noexcept override;

  /// Pairs handed to Bullet's narrowphase so far: what a scene does not need is not searched.
  [[nodiscard]] std::uint64_t searches() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
