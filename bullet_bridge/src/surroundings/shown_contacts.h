#pragma once

#include <memory>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "coordination/src/island/contact_tally.h"

namespace tandem {

// clang-format off
/// Shows the island's contacts to the host as Bullet shows its own: as manifolds of the world's
/// dispatcher, with points and impulses, owned by an algorithm in the pair of the broadphase.
///
///   pre-tick    hide    Bullet's solver and islands see no manifold of ours
///   actions     unhide  the host's actions see the points of the step before
///   post-tick   show    points of the step; Bullet's global callbacks for points are called
///   in between  whatever ends a pair in Bullet (removal of a body, another filter, the end of its
///               overlap) destroys the algorithm, and with it the manifolds
// clang-format on
///
/// Worlds may have one dispatcher: each of them has all manifolds of it in its solver. So the sites
/// of all hide theirs while one of these worlds steps.
///
/// For the thread that steps the host's world.
class ShownContacts {
 public:
  /// `world` must live until clear(), or until none is shown.
  explicit ShownContacts(btDiscreteDynamicsWorld& world);
  ~ShownContacts();
  ShownContacts(const ShownContacts&) = delete;
  ShownContacts& operator=(const ShownContacts&) = delete;

  /// Takes all manifolds out of the dispatcher's list until unhide(), without a callback.
  void hide() noexcept;
  /// Puts them back, unless another world of the dispatcher steps.
  void unhide();

  /// @name Between hide() and unhide(): the points of a host step.
  /// @{
  void begin() noexcept;
  /// The points between two objects of the world; impulses act on `a`. All have the same bodies of
  /// the island.
  void show(const btCollisionObject& a, const btCollisionObject& b,
            const std::vector<const ContactSum*>& points);
  /// Ends what was not shown, but for pairs that rest: `stays(index_a, index_b)` is asked for
  /// these.
  template <typename Stays>
  void end(Stays stays) {
    for (std::size_t i = pairs_.size(); i-- > 0;) {
      Pair& pair = *pairs_[i];
      if (pair.is_reported || (pair.rests && stays(pair.index_a, pair.index_b))) continue;
      remove(pair);
    }
  }
  /// @}

  /// Removes all, for good.
  void clear();

 private:
  class Algorithm;
  class Action;
  /// Holds the sites of all worlds that have one dispatcher.
  struct Group {
    explicit Group(btCollisionDispatcher&) {}
    std::vector<ShownContacts*> members;
  };
  /// Two objects, which are in the world as long as there is an algorithm.
  struct Pair {
    const btCollisionObject* a;
    const btCollisionObject* b;
    Algorithm* algorithm = nullptr;                  ///< null: the broadphase has no pair yet
    std::vector<btPersistentManifold*> manifolds{};  ///< of up to four points each
    Vec3 owed_W = Vec3::Zero();                      ///< impulse that could not be shown yet [N s]
    BodyIndex index_a = 0, index_b = 0;
    bool is_reported = false, rests = false;
  };

  void takeOut() noexcept;
  void putBack();
  [[nodiscard]] Pair& findOrAdd(const btCollisionObject& a, const btCollisionObject& b);
  [[nodiscard]] bool attach(Pair& pair);
  [[nodiscard]] btPersistentManifold* makeManifold(const Pair& pair);
  void fill(btPersistentManifold& manifold, const Pair& pair, const ContactSum* const* points,
            int count);
  void drop(btPersistentManifold* manifold);
  /// The algorithm of a pair is destroyed.
  void forget(Pair& pair);
  void remove(Pair& pair);

  btDiscreteDynamicsWorld& world_;
  btCollisionDispatcher* dispatcher_;  ///< null: of another class; nothing is shown
  std::vector<std::unique_ptr<Pair>> pairs_;
  std::size_t next_ = 0;            ///< place after the last pair found
  std::shared_ptr<Group> group_;    ///< null: nothing is shown, or no more
  std::unique_ptr<Action> action_;  ///< null until the first is shown
  bool is_stepping_ = false;        ///< from hide() to unhide()
  // Places in the dispatcher's list.
  std::vector<btPersistentManifold*> listed_;  ///< ours, in order, at the last unhide()
  int first_ = 0;                              ///< place of the first at the last unhide()
  bool is_changed_ = false;                    ///< some came or went since then
  bool is_hidden_ = false;
};

}  // namespace tandem
