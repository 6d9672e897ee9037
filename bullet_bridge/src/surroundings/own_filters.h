#pragma once

#include <cstddef>
#include <vector>

class btCollisionObject;
class btDiscreteDynamicsWorld;

namespace tandem {

/// Filters of native contact that we store in objects of the host. A mark beside each tells them
/// from the host's: it may ignore the same pair, or make another object at the address.
///
/// Keepers may leave the host's world with filters of ours in them. These go when the keeper is
/// back. Not during collision detection.
class OwnFilters {
 public:
  explicit OwnFilters(btDiscreteDynamicsWorld& host) : host_(host) {}

  /// Switches Bullet's contact of the pair off. Both are in the world.
  void add(btCollisionObject& keeper, btCollisionObject& other);
  /// Switches it on again. Each may have left the world or been deleted.
  void remove(btCollisionObject* keeper, btCollisionObject* other);
  /// Removes filters from keepers that have come back.
  void removeLate();
  /// The world that would bring keepers back has gone.
  void forgetLate() noexcept { late_.clear(); }

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

  void noteLate(btCollisionObject* keeper, btCollisionObject* other);

  btDiscreteDynamicsWorld& host_;
  std::vector<Late> late_;
};

}  // namespace tandem
