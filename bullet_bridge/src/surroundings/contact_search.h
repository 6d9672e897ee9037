#pragma once

#include <memory>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

#include "coordination/src/island/contact_finder.h"
#include "surroundings/private_copies.h"

namespace tandem {

/// Bullet's narrowphase on private copies: pairs of a few bodies with each other and with standing
/// objects near them.
///
/// Two sides use it, possibly in two threads. The host's side changes the set of objects with
/// addBody ... showSurfaces, then calls prepare(). Changes take effect in commit(), on the tick's
/// side. commit() neither allocates nor reads the host's world. The next prepare() frees replaced
/// data.
class ContactSearch {
 public:
  /// `min_bounce_speed`: restitution acts above this approach speed [m/s], as in the host's world.
  explicit ContactSearch(double min_bounce_speed);
  ~ContactSearch();
  ContactSearch(const ContactSearch&) = delete;
  ContactSearch& operator=(const ContactSearch&) = delete;

  /// @name The host's side; may allocate.
  /// @{
  [[nodiscard]] const Vec3& origin() const noexcept { return wanted_origin_W_; }
  /// Moves the origin of all copies: bodies go to `states`, standing ones by placeStanding().
  void setOrigin(const Vec3& origin_W, const std::vector<RigidState>& states);

  [[nodiscard]] const std::vector<std::unique_ptr<PrivateCopy>>& standing() const {
    return standing_;
  }
  [[nodiscard]] const std::vector<std::unique_ptr<PrivateCopy>>& bodies() const { return bodies_; }

  /// Adds a copy, and a pair with each copy for which `meets` is true.
  template <typename Meets>
  void addBody(BodyIndex index, btCollisionObject& original, Meets meets) {
    auto copy = std::make_unique<PrivateCopy>(original, index);
    for (const auto& body : bodies_)
      if (meets(*copy, *body)) addPair(*copy, *body);
    for (const auto& object : standing_)
      if (meets(*copy, *object)) addPair(*copy, *object);
    bodies_.push_back(std::move(copy));
    is_changed_ = true;
  }
  template <typename Meets>
  void addStanding(btCollisionObject& original, Meets meets) {
    auto copy = std::make_unique<PrivateCopy>(original, kStanding);
    copy->place(copy->findOriginal(wanted_origin_W_));
    for (const auto& body : bodies_)
      if (meets(*body, *copy)) addPair(*body, *copy);
    standing_.push_back(std::move(copy));
    is_changed_ = true;
  }
  /// Moves a standing copy to the pose of its original. True if that changes it.
  bool placeStanding(PrivateCopy& copy);
  /// Removes a copy. Calls `visit` with it and each partner of its pairs.
  template <typename Visit>
  void remove(const btCollisionObject* original, Visit visit) {
    for (const Neighbours& link : links_) {
      if (link.a->original == original) visit(*link.a, *link.b);
      if (link.b->original == original) visit(*link.b, *link.a);
    }
    erase(original);
  }
  /// Copies friction and restitution from the originals, which must all be in the world.
  void showSurfaces();
  /// Completes a change for the next commit().
  void prepare();
  /// @}

  /// @name The tick's side; real-time safe.
  /// @{
  /// Applies the last prepare().
  void commit() noexcept;
  void lookAround(const std::vector<RigidState>& states, const std::vector<double>& reach,
                  std::vector<char>& awake, std::vector<char>& near) noexcept;
  void find(const std::vector<RigidState>& states, std::vector<RigidContact>& contacts) noexcept;
  /// Number of pairs passed to Bullet's narrowphase so far.
  [[nodiscard]] std::uint64_t searches() const noexcept { return searches_; }
  /// @}

 private:
  /// Two copies that may touch, on the host's side.
  struct Neighbours {
    PrivateCopy* a;     ///< a body
    PrivateCopy* b;     ///< a body or standing
    std::size_t place;  ///< index of its pair in the present book; kNowhere: none
  };
  static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

  struct Pair {
    PrivateCopy* a;
    PrivateCopy* b;
    btCollisionAlgorithm* algorithm = nullptr;
    bool near = false;
  };
  /// Pairs and lists that the tick uses.
  struct Book {
    std::vector<Pair> pairs;
    std::vector<PrivateCopy*> copy_of;               ///< by body; null: no copy
    std::vector<std::vector<std::size_t>> pairs_of;  ///< by body: indices in pairs
    std::vector<std::size_t> near, were_near;        ///< indices of near pairs, ascending
    std::vector<BodyIndex> awake;                    ///< in the last lookAround()
  };
  /// Dispatcher with room for all its manifolds from the start.
  struct Dispatcher final : btCollisionDispatcher {
    Dispatcher(btCollisionConfiguration* configuration, int room)
        : btCollisionDispatcher(configuration) {
      m_manifoldsPtr.reserve(room);
    }
  };
  struct Placing {
    PrivateCopy* copy;
    btTransform pose;
  };
  struct Surfacing {
    PrivateCopy* copy;
    Surface surface;
  };

  void addPair(PrivateCopy& a, PrivateCopy& b) { links_.push_back({&a, &b, kNowhere}); }
  void sortLinks();
  void fillDraft();
  void erase(const btCollisionObject* original);
  void place(BodyIndex body, const RigidState& state) noexcept;
  template <typename Visit>
  void forEachPairOf(BodyIndex body, Visit visit);
  void release(Pair& pair) noexcept;
  void search(Pair& pair, std::vector<RigidContact>& contacts) noexcept;
  void slideAlong(const Pair& pair) noexcept;
  [[nodiscard]] bool overlaps(const Pair& pair, const Region& a, const Region& b) const noexcept;

  btDefaultCollisionConfiguration configuration_;
  Dispatcher dispatcher_;
  btDispatcherInfo dispatch_;
  double min_bounce_speed_;

  // The host's side.
  std::vector<std::unique_ptr<PrivateCopy>> bodies_, standing_;
  std::vector<std::unique_ptr<PrivateCopy>> removed_;  ///< since the last prepare()
  std::vector<std::unique_ptr<PrivateCopy>> going_;    ///< in the present book, not in the next
  std::vector<Neighbours> links_;
  Vec3 wanted_origin_W_ = Vec3::Zero();
  bool is_changed_ = false;  ///< since the last prepare()

  // Result of prepare() for commit().
  Book draft_;
  bool is_drawn_ = false;
  std::vector<Placing> placings_;
  std::vector<Surfacing> surfacings_;
  std::vector<RigidState> moved_states_;  ///< states of bodies after a change of origin; else empty

  // The tick's side.
  Book book_;
  Vec3 origin_W_ = Vec3::Zero();
  btManifoldArray manifolds_;  // work space
  std::uint64_t searches_ = 0;
};

}  // namespace tandem
