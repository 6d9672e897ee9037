#pragma once

#include <memory>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

namespace tandem {

class OwnFilters;

/// Lets a host's contactTest() and contactPairTest() see pairs whose contact is the island's.
///
/// Bullet's algorithms for a plane, and for the boxes of a compound, find nothing for a filtered
/// pair: they make no manifold for it. Functions of ours stand in the dispatcher's tables for
/// theirs, and give them one. Other pairs, and functions of the host's own, stay as they were. For
/// the thread that steps the host's world.
class FilteredQueries {
 public:
  /// Changes the tables. `dispatcher` must outlive this.
  explicit FilteredQueries(btCollisionDispatcher& dispatcher);
  /// Restores them, where the host has not put functions of its own.
  ~FilteredQueries();
  FilteredQueries(const FilteredQueries&) = delete;
  FilteredQueries& operator=(const FilteredQueries&) = delete;

  /// Pairs of these filters are found from now on.
  void add(const OwnFilters& filters) { filters_.push_back(&filters); }
  void remove(const OwnFilters& filters) { std::erase(filters_, &filters); }

 private:
  class CreateFunc;
  template <typename Base>
  class WithManifold;
  /// A place in one of the dispatcher's two tables.
  struct Place {
    btCollisionAlgorithmCreateFunc** entry;
    CreateFunc* own;
  };

  void replace(btCollisionAlgorithmCreateFunc*& entry);
  [[nodiscard]] bool isOurs(const btCollisionObject& a, const btCollisionObject& b) const noexcept;

  std::vector<const OwnFilters*> filters_;
  std::vector<std::unique_ptr<CreateFunc>> functions_;
  std::vector<Place> places_;
};

}  // namespace tandem
