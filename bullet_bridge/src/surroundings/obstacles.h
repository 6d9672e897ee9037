#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "tandem/coordination/shape.h"

#include "coordination/src/island/contact_finder.h"
#include "coordination/src/island/contact_tally.h"
#include "coordination/src/island/island.h"

class btCollisionObject;
class btDiscreteDynamicsWorld;

#pragma GCC visibility push(default)
namespace tandem {

/// Rigid surroundings of the island's bodies: static objects of the host's world near them, and the
/// bodies themselves for each other. They are found once per host step. Contacts are searched at
/// each inner step of the island, by Bullet's narrowphase on private copies.
///
/// The private origin is near the first body, so a float Bullet resolves tens of nanometres
/// anywhere. Friction, restitution and margins are those of the host's objects at the last
/// update(). Rolling and spinning friction act, contact stiffness and anisotropic friction do not.
/// Shapes are copied when they come near, and of meshes and height fields the triangles that are
/// near: search() notices another scaling, margin, size or child, but not a corner that moved
/// inside. So the host may delete any object and shape that its world does not have any more, in
/// any moment.
///
/// Native contact of an island body with a candidate or another island body is filtered meanwhile.
/// Between two links of multi-bodies it stays Bullet's: they have no list of ignored objects.
/// Which pairs touch is the host's decision: groups, masks, ignored pairs, an overlap filter
/// callback, and needsCollision() and needsResponse() of its dispatcher are asked once per search.
/// With a near callback of the host's all contact stays Bullet's, and so does that of pairs whose
/// dispatcher minds no filter.
/// It stays Bullet's for shapes that cannot be copied (convex classes of the host's own, signed
/// distance fields), and for objects whose contact points the host changes in
/// `gContactAddedCallback`. Kinematic objects are no candidates: they can be bodies. Bullet's
/// global contact callbacks are never called here.
///
/// Two threads may share it. addBody(), removeBody(), addSphere() and search() are for the thread
/// that steps the host's world. Their results take effect in commit(). commit(), nearSpheres(),
/// lookAround() and find() are for the thread that ticks, while the other waits. They allocate only
/// at first touch.
class Obstacles final : public ContactFinder {
 public:
  /// `host` must outlive this object unless forgetWorld() was called. Bodies must too unless they
  /// have left the world.
  explicit Obstacles(btDiscreteDynamicsWorld& host);
  ~Obstacles() override;

  /// Not in the tick. Makes `body` of the host's world the island body `index`. Throws
  /// tandem::Error if the index has a body already, or the body is static. Also throws for a shape
  /// neither convex nor compound (for kinematic bodies: a plane). Two kinematic bodies never touch.
  void addBody(BodyIndex index, btCollisionObject& body);

  /// Not in the tick. The form in which spheres feel a moving body of the host's world; nothing if
  /// no part of its shape has one. A form that takes time is made once and kept.
  [[nodiscard]] std::optional<Shape> findForm(const btCollisionObject& body);

  /// Not in the tick. Frees the index; native contact is the host's again.
  void removeBody(BodyIndex index);

  /// Not in the tick. The host's world ends: after the commit() no body is held and nothing is
  /// near.
  void forgetWorld();

  /// Set-up. Adds a haptic sphere (device or proxy); nearSpheres() reports obstacles near it.
  void addSphere(BodyIndex index, double radius);

  /// Once per host step, from the host's thread. Finds the static objects within `margin` [m] of
  /// each dynamic body and sphere; `states` is by index. May allocate when a new obstacle comes
  /// near. A mesh near a sphere takes some microseconds per triangle the first time. True if an
  /// object came, left or moved: wake the bodies that rested on it. With `moves`, by index, it
  /// searches around moving bodies only and keeps earlier results; call it without now and then.
  bool search(const std::vector<RigidState>& states, double margin,
              const std::vector<char>* moves = nullptr);

  /// From the host's thread, between its steps. True if the host changed surface, place, shape or
  /// filter of an object that the last search() found: search() again, before the island goes on.
  [[nodiscard]] bool hasNews();

  /// Applies all added, removed and found objects. Real-time safe. nearSpheres() then returns
  /// another vector.
  void commit() noexcept;

  /// Calls search() and commit().
  bool update(const std::vector<RigidState>& states, double margin,
              const std::vector<char>* moves = nullptr) {
    const bool has_changed = search(states, margin, moves);
    commit();
    return has_changed;
  }

  /// The host has moved all of its world by `offset_W` [m]. For the thread that ticks, while the
  /// other waits. Real-time safe.
  void shiftOrigin(const Vec3& offset_W) noexcept;

  /// Obstacles near the spheres, which tell what changed in the last commit(), of shapes that
  /// findForm() supports; of compounds each part.
  [[nodiscard]] const std::vector<Obstacle>& nearSpheres() const noexcept;

  void lookAround(const std::vector<RigidState>& states, const std::vector<double>& reach,
                  std::vector<char>& awake, std::vector<char>& near) noexcept override;
  void find(const std::vector<RigidState>& states,
            std::vector<RigidContact>& contacts) noexcept override;

  /// For the host's thread, before and after Bullet's step: the host sees the contacts that the
  /// island decided, as manifolds of its world with their impulses (ShownContacts).
  void hideContacts() noexcept;
  void unhideContacts();
  /// New contacts, for unhideContacts(). `still`, by index: bodies that nothing moves now. Pairs at
  /// rest stay shown until one of the two moves.
  void showContacts(const std::vector<ContactSum>& sums, const std::vector<char>& still);

  /// Number of pairs passed to Bullet's narrowphase so far.
  [[nodiscard]] std::uint64_t searches() const noexcept;
  /// Number of pairs whose kept contact answered instead.
  [[nodiscard]] std::uint64_t frozenSearches() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
