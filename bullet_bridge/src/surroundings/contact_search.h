#pragma once

#include <memory>
#include <vector>

#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

#include "coordination/src/island/contact_finder.h"
#include "surroundings/contact_pair.h"
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
  /// The private origin goes along with the whole world: copies stay where they are.
  void shiftOrigin(const Vec3& offset_W) noexcept {
    work_.origin_W += offset_W;
    wanted_origin_W_ += offset_W;
    for (RigidState& state : moved_states_) state.p_W += offset_W;
  }

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
  /// Calls `visit` with each partner of a copy's pairs.
  template <typename Visit>
  void visitPartners(const PrivateCopy& copy, Visit visit) const {
    for (const Neighbours& link : links_)
      if (link.a == &copy || link.b == &copy) visit(link.a == &copy ? *link.b : *link.a);
  }
  /// Ends the pairs of a copy, with `visit` as in remove(), and adds those for which `meets` holds.
  template <typename Visit, typename Meets>
  void renewPairs(PrivateCopy& copy, Visit visit, Meets meets) {
    std::erase_if(links_, [&](const Neighbours& link) {
      if (link.a != &copy && link.b != &copy) return false;
      visit(copy, link.a == &copy ? *link.b : *link.a);
      return true;
    });
    for (const auto& body : bodies_)
      if (body.get() != &copy && meets(*body, copy)) addPair(*body, copy);
    if (copy.index != kStanding)
      for (const auto& object : standing_)
        if (meets(copy, *object)) addPair(copy, *object);
    is_changed_ = true;
  }
  /// Reads friction and restitution of the originals, which must all be in the world. True if those
  /// of a pair have changed.
  bool showSurfaces();
  /// True if the host set another function that combines surfaces since the last showSurfaces().
  [[nodiscard]] bool hasNewCombiners() const noexcept { return !(Combiners::now() == combiners_); }
  /// True if the original of a standing copy, which must be in the world, has been moved.
  [[nodiscard]] bool hasMoved(const PrivateCopy& copy) const {
    return !equalBits(copy.findOriginal(wanted_origin_W_).rounded, copy.object.getWorldTransform());
  }
  /// Copies the triangles of meshes that pairs may reach, within `margin` [m] of the bodies at
  /// `states`. All originals must be in the world, with the shapes that were copied.
  void gatherTriangles(const std::vector<RigidState>& states, btScalar margin);
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
  /// Number of pairs passed to Bullet's narrowphase so far, and of those that kept contact
  /// answered.
  [[nodiscard]] std::uint64_t searches() const noexcept { return searches_; }
  [[nodiscard]] std::uint64_t frozenSearches() const noexcept { return frozen_searches_; }
  /// @}

 private:
  /// A mesh of a pair, on the host's side.
  struct MeshNear {
    const Part* mesh;
    bool is_of_a;
    TriangleRun fresh;           ///< for the next commit(); else the one before, to be used again
    bool is_fresh = false;       ///< since the last commit()
    Region covered = kNoRegion;  ///< by the triangles of the last gathering
  };
  /// Two copies that may touch, on the host's side.
  struct Neighbours {
    PrivateCopy* a;  ///< a body
    PrivateCopy* b;  ///< a body or standing
    Material material;
    std::vector<MeshNear> meshes;
    std::size_t place = kNowhere;  ///< index of its pair in the present book; kNowhere: none
    bool is_new_material = false;  ///< since the last commit()
  };
  static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

  /// Pairs and lists that the tick uses.
  struct Book {
    std::vector<ContactPair> pairs;
    std::vector<PrivateCopy*> copy_of;               ///< by body; null: no copy
    std::vector<std::vector<std::size_t>> pairs_of;  ///< by body: indices in pairs
    std::vector<std::size_t> near, were_near;        ///< indices of near pairs, ascending
    std::vector<BodyIndex> awake;                    ///< in the last lookAround()
  };
  struct Placing {
    PrivateCopy* copy;
    PrivatePose pose;
  };
  /// Bullet's functions that combine surfaces; a host may set its own.
  struct Combiners {
    btScalar (*functions[4])(const btCollisionObject*, const btCollisionObject*) = {};

    [[nodiscard]] static Combiners now() noexcept;
    bool operator==(const Combiners&) const noexcept = default;
  };

  void addPair(PrivateCopy& a, PrivateCopy& b);
  void sortLinks();
  void fillDraft();
  void erase(const btCollisionObject* original);
  void place(BodyIndex body, const RigidState& state) noexcept;
  template <typename Visit>
  void forEachPairOf(BodyIndex body, Visit visit);
  void commit(Neighbours& link) noexcept;
  [[nodiscard]] btTransform findPose(const PrivateCopy& copy,
                                     const std::vector<RigidState>& states) const;

  btDefaultCollisionConfiguration configuration_;
  QuietDispatcher dispatcher_;
  ContactPair::WorkSpace work_;

  // The host's side.
  std::vector<std::unique_ptr<PrivateCopy>> bodies_, standing_;
  std::vector<std::unique_ptr<PrivateCopy>> removed_;  ///< since the last prepare()
  std::vector<std::unique_ptr<PrivateCopy>> going_;    ///< in the present book, not in the next
  std::vector<Neighbours> links_;
  Vec3 wanted_origin_W_ = Vec3::Zero();
  Combiners combiners_ = Combiners::now();  ///< at the last showSurfaces()
  bool is_changed_ = false;                 ///< since the last prepare()

  // Result of prepare() for commit().
  Book draft_;
  bool is_drawn_ = false;
  bool has_news_ = false;  ///< a link has material or triangles for the next commit()
  std::vector<Placing> placings_;
  std::vector<RigidState> moved_states_;  ///< states of bodies after a change of origin; else empty

  // The tick's side.
  Book book_;
  std::uint64_t searches_ = 0, frozen_searches_ = 0;
};

}  // namespace tandem
