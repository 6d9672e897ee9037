#pragma once

#include <memory>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

#include "tandem/coordination/contact_finder.h"

#include "private_copies.h"

namespace tandem {

/// Bullet's narrowphase on private copies: pairs of a few bodies with each other and with what
/// stands near them.
class ContactSearch {
 public:
  /// Restitution acts from this approach speed on [m/s], as in the host's world.
  explicit ContactSearch(double min_bounce_speed);
  ~ContactSearch();
  ContactSearch(const ContactSearch&) = delete;
  ContactSearch& operator=(const ContactSearch&) = delete;

  [[nodiscard]] const Vec3& origin() const noexcept { return origin_W_; }
  void setOrigin(const Vec3& origin_W) { origin_W_ = origin_W; }

  /// Standing copies; to be placed again after a change of origin.
  [[nodiscard]] const std::vector<std::unique_ptr<PrivateCopy>>& standing() const {
    return standing_;
  }
  [[nodiscard]] const std::vector<std::unique_ptr<PrivateCopy>>& bodies() const { return bodies_; }

  /// Not in the tick. Each makes pairs with all copies that `meets` says; returns nothing known by
  /// address only.
  template <typename Meets>
  void addBody(BodyIndex index, btCollisionObject& original, Meets meets) {
    auto copy = std::make_unique<PrivateCopy>(original, index);
    for (const auto& body : bodies_)
      if (meets(*copy, *body)) addPair(*copy, *body);
    for (const auto& object : standing_)
      if (meets(*copy, *object)) addPair(*copy, *object);
    bodies_.push_back(std::move(copy));
    sortPairs();
  }
  template <typename Meets>
  void addStanding(btCollisionObject& original, Meets meets) {
    auto copy = std::make_unique<PrivateCopy>(original, kStanding);
    copy->placeAsOriginal(origin_W_);
    for (const auto& body : bodies_)
      if (meets(*body, *copy)) addPair(*body, *copy);
    standing_.push_back(std::move(copy));
    sortPairs();
  }
  /// Calls `visit` with its copy and that of each partner it was paired with.
  template <typename Visit>
  void remove(const btCollisionObject* original, Visit visit) {
    for (const Pair& pair : pairs_) {
      if (pair.a->original == original) visit(*pair.a, *pair.b);
      if (pair.b->original == original) visit(*pair.b, *pair.a);
    }
    erase(original);
  }

  /// Not in the tick: friction and restitution as the originals have them now, all in the world.
  void copySurfaces() {
    for (const auto& body : bodies_) body->copySurface();
    for (const auto& object : standing_) object->copySurface();
  }

  /// Not in the tick: all copies to where their bodies are.
  void placeAll(const std::vector<RigidState>& states) noexcept;

  void lookAround(const std::vector<RigidState>& states, const std::vector<double>& reach,
                  std::vector<char>& awake, std::vector<char>& near) noexcept;
  void find(const std::vector<RigidState>& states, std::vector<RigidContact>& contacts) noexcept;

  /// Pairs handed to Bullet's narrowphase so far.
  [[nodiscard]] std::uint64_t searches() const noexcept { return searches_; }

 private:
  struct Pair {
    PrivateCopy* a;  ///< a body
    PrivateCopy* b;  ///< a body or standing
    btCollisionAlgorithm* algorithm = nullptr;
    bool near = false;
  };

  void addPair(PrivateCopy& a, PrivateCopy& b) { pairs_.push_back({&a, &b, nullptr, false}); }
  void sortPairs();
  void indexPairs();
  void place(BodyIndex body, const std::vector<RigidState>& states) noexcept;
  template <typename Visit>
  void forEachPairOf(BodyIndex body, Visit visit);
  void erase(const btCollisionObject* original);
  void release(Pair& pair) noexcept;
  void search(Pair& pair, std::vector<RigidContact>& contacts) noexcept;
  void slideAlong(const Pair& pair) noexcept;
  [[nodiscard]] bool overlaps(const Pair& pair, const Region& a, const Region& b) const noexcept;

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDispatcherInfo dispatch_;
  double min_bounce_speed_;
  Vec3 origin_W_ = Vec3::Zero();
  std::vector<std::unique_ptr<PrivateCopy>> bodies_, standing_;
  std::vector<Pair> pairs_;
  std::vector<PrivateCopy*> copy_of_;               ///< by body; null: not held
  std::vector<std::vector<std::size_t>> pairs_of_;  ///< by body: places in pairs_
  std::vector<std::size_t> near_, were_near_;       ///< the same of near pairs, ascending
  std::vector<BodyIndex> awake_;                    ///< in the last lookAround()
  btManifoldArray manifolds_;                       // work space
  std::uint64_t searches_ = 0;
};

}  // namespace tandem
