#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

// Bullet's narrowphase without its global callbacks. A host may set them at any time, and expects
// them in its own thread, for its own objects.
//
// Bullet calls them where it adds a point, refreshes points and gives a manifold back. Here the
// algorithms write into manifolds that stay empty, so that Bullet has nothing to refresh. The
// points go to a manifold that only these functions touch.

namespace tandem {

/// Bullet's dispatcher for private copies: manifolds are in no list, and go without a callback.
/// Real-time safe while the pools last.
class QuietDispatcher final : public btCollisionDispatcher {
 public:
  explicit QuietDispatcher(btCollisionConfiguration* configuration)
      : btCollisionDispatcher(configuration) {}

  /// Contact farther than this [m] is none, in manifolds made from now on.
  void setBreakingThreshold(btScalar distance) noexcept { breaking_threshold_ = distance; }

  btPersistentManifold* getNewManifold(const btCollisionObject* a,
                                       const btCollisionObject* b) override;
  void releaseManifold(btPersistentManifold* manifold) override;
  void clearManifold(btPersistentManifold* manifold) override { manifold->setNumContacts(0); }

 private:
  btScalar breaking_threshold_ = 0;
};

/// Takes the points of an algorithm into `kept`. Like Bullet's class, but without material and
/// callbacks.
class QuietResult final : public btManifoldResult {
 public:
  /// `shows_kept`: the algorithm asks how many points there are, as that of planes does. `scale`:
  /// lengths that it knows are so many times ours.
  QuietResult(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
              btPersistentManifold& kept, bool shows_kept, btScalar scale)
      : btManifoldResult(a, b), kept_(kept), shows_kept_(shows_kept), scale_(scale) {}

  void addContactPoint(const btVector3& normal_on_b, const btVector3& point_on_b,
                       btScalar depth) override;

 private:
  btPersistentManifold& kept_;
  bool shows_kept_;
  btScalar scale_;
};

/// Moves the points along with their objects, and drops those that came apart, as
/// btPersistentManifold::refreshContactPoints() does.
void refreshQuietly(btPersistentManifold& manifold) noexcept;

}  // namespace tandem
