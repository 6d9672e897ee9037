#include "surroundings/filtered_queries.h"

#include <algorithm>
#include <new>
#include <utility>

#include <BulletCollision/CollisionDispatch/btBoxBoxCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btConvexPlaneCollisionAlgorithm.h>

#include "surroundings/own_filters.h"

namespace tandem {
namespace {

using Table = btCollisionAlgorithmCreateFunc* [MAX_BROADPHASE_COLLISION_TYPES]
    [MAX_BROADPHASE_COLLISION_TYPES];

/// The dispatcher's tables. Naming a protected member through a derived class is legal C++.
struct Access : btCollisionDispatcher {
  static Table& contactPoints(btCollisionDispatcher& dispatcher) {
    return dispatcher.*(&Access::m_doubleDispatchContactPoints);
  }
  static Table& closestPoints(btCollisionDispatcher& dispatcher) {
    return dispatcher.*(&Access::m_doubleDispatchClosestPoints);
  }
};

}  // namespace

/// Bullet's algorithm with a manifold that is not its own.
template <typename Base>
class FilteredQueries::WithManifold final : public Base {
 public:
  template <typename... Arguments>
  explicit WithManifold(btPersistentManifold& manifold, Arguments&&... arguments)
      : Base(&manifold, std::forward<Arguments>(arguments)...), manifold_(manifold) {}
  ~WithManifold() override { this->m_dispatcher->releaseManifold(&manifold_); }
  WithManifold(const WithManifold&) = delete;
  WithManifold& operator=(const WithManifold&) = delete;

 private:
  btPersistentManifold& manifold_;
};

class FilteredQueries::CreateFunc final : public btCollisionAlgorithmCreateFunc {
 public:
  CreateFunc(const FilteredQueries& owner, btCollisionAlgorithmCreateFunc& of_bullet)
      : below(of_bullet), owner_(owner), of_plane_(dynamic_cast<PlaneFunc*>(&of_bullet)) {}

  /// True for functions of algorithms that refuse filtered pairs.
  static bool mayReplace(btCollisionAlgorithmCreateFunc* function) {
    return dynamic_cast<PlaneFunc*>(function) || dynamic_cast<BoxFunc*>(function);
  }

  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* a,
                                                 const btCollisionObjectWrapper* b) override {
    const btCollisionObject *first = a->getCollisionObject(), *second = b->getCollisionObject();
    btPersistentManifold* manifold = owner_.isOurs(*first, *second)
                                         ? info.m_dispatcher1->getNewManifold(first, second)
                                         : nullptr;
    if (manifold == nullptr) return below.CreateCollisionAlgorithm(info, a, b);
    if (of_plane_)
      return make<btConvexPlaneCollisionAlgorithm>(*manifold, info, a, b, below.m_swapped,
                                                   of_plane_->m_numPerturbationIterations,
                                                   of_plane_->m_minimumPointsPerturbationThreshold);
    return make<btBoxBoxCollisionAlgorithm>(*manifold, info, a, b);
  }

  btCollisionAlgorithmCreateFunc& below;

 private:
  using PlaneFunc = btConvexPlaneCollisionAlgorithm::CreateFunc;
  using BoxFunc = btBoxBoxCollisionAlgorithm::CreateFunc;

  template <typename Base, typename... Arguments>
  static btCollisionAlgorithm* make(btPersistentManifold& manifold,
                                    btCollisionAlgorithmConstructionInfo& info,
                                    Arguments&&... arguments) {
    using Query = WithManifold<Base>;
    // The dispatcher's pool has room for Bullet's largest.
    static_assert(sizeof(Query) <= sizeof(btConvexConvexAlgorithm));
    void* place = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Query));
    return new (place) Query(manifold, info, std::forward<Arguments>(arguments)...);
  }

  const FilteredQueries& owner_;
  PlaneFunc* of_plane_;  ///< null: of two boxes
};

FilteredQueries::FilteredQueries(btCollisionDispatcher& dispatcher) {
  for (Table* table : {&Access::contactPoints(dispatcher), &Access::closestPoints(dispatcher)})
    for (auto& row : *table)
      for (btCollisionAlgorithmCreateFunc*& entry : row)
        if (CreateFunc::mayReplace(entry)) replace(entry);
}

FilteredQueries::~FilteredQueries() {
  for (const Place& place : places_)
    if (*place.entry == place.own) *place.entry = &place.own->below;
}

void FilteredQueries::replace(btCollisionAlgorithmCreateFunc*& entry) {
  const auto known = std::find_if(functions_.begin(), functions_.end(),
                                  [&](const auto& own) { return &own->below == entry; });
  CreateFunc* own = known == functions_.end() ? nullptr : known->get();
  if (own == nullptr)
    own = functions_.emplace_back(std::make_unique<CreateFunc>(*this, *entry)).get();
  entry = own;
  places_.push_back({&entry, own});
}

bool FilteredQueries::isOurs(const btCollisionObject& a,
                             const btCollisionObject& b) const noexcept {
  return std::any_of(filters_.begin(), filters_.end(),
                     [&](const OwnFilters* filters) { return filters->has(a, b); });
}

}  // namespace tandem
