#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <utility>
#include <vector>

class btCollisionObject;
class btDiscreteDynamicsWorld;

namespace tandem {

class FilteredQueries;

/// Filters of native contact that we store in objects of the host. A mark beside each tells them
/// from the host's: it may ignore the same pair, or make another object at the address.
///
/// Keepers may leave the host's world with filters of ours in them. These go when the keeper is
/// back. Not during collision detection.
class OwnFilters {
 public:
  explicit OwnFilters(btDiscreteDynamicsWorld& host);
  ~OwnFilters();
  OwnFilters(const OwnFilters&) = delete;
  OwnFilters& operator=(const OwnFilters&) = delete;

  /// Switches Bullet's contact of the pair off. Both are in the world.
  void add(btCollisionObject& keeper, btCollisionObject& other);
  /// Switches it on again. Each may have left the world or been deleted.
  void remove(btCollisionObject* keeper, btCollisionObject* other);
  /// Removes filters from keepers that have come back.
  void removeLate();
  /// The world that would bring keepers back goes, perhaps with its dispatcher.
  void forgetWorld() noexcept;

  /// True if we have switched off the contact of this pair.
  [[nodiscard]] bool has(const btCollisionObject& a, const btCollisionObject& b) const noexcept;

  /// Number of our filters in the object.
  [[nodiscard]] static int countIn(btCollisionObject& keeper);
  /// Number of objects that the host wants it to ignore.
  [[nodiscard]] static int countOfHost(btCollisionObject& keeper);

 private:
  /// Filters in a keeper that has left the world. Addresses only.
  struct Late {
    btCollisionObject* keeper;
    std::vector<btCollisionObject*> others;
  };

  /// Lets the host's queries see our pairs.
  void openQueries();
  void noteLate(btCollisionObject* keeper, btCollisionObject* other);

  btDiscreteDynamicsWorld& host_;
  std::vector<Late> late_;
  std::set<std::pair<const btCollisionObject*, const btCollisionObject*>> pairs_;  ///< keeper first
  std::shared_ptr<FilteredQueries> queries_;  ///< of all sites of the dispatcher
};

}  // namespace tandem
