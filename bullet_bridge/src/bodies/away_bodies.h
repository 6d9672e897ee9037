#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "bodies/haptic_body.h"

namespace tandem {

/// Bodies that the host took out of its world while they were held. Only in the world can they get
/// back what is theirs.
class AwayBodies {
 public:
  explicit AwayBodies(const btDiscreteDynamicsWorld& world) : world_(world) {
    bodies_.reserve(kMost);
  }

  /// Restores a body now, or once it is back.
  void release(std::unique_ptr<HapticBody> body) noexcept {
    if (!body || body->isInWorld()) return;
    // A host that deletes bodies all the time must not fill the memory.
    if (bodies_.size() == kMost) restoreReturned();
    if (bodies_.size() == kMost) bodies_.erase(bodies_.begin());
    bodies_.push_back(std::move(body));
    objects_ = world_.getNumCollisionObjects();
  }
  /// Restores those that are back.
  void restoreReturned() noexcept {
    if (bodies_.empty()) return;
    std::erase_if(bodies_, [](const auto& body) { return body->isInWorld(); });
    objects_ = world_.getNumCollisionObjects();
  }
  /// True if the world has another number of objects since the last look for those.
  [[nodiscard]] bool mayBeBack() const noexcept {
    return !bodies_.empty() && world_.getNumCollisionObjects() != objects_;
  }
  /// Restores those that are back, and gives up the others.
  void clear() noexcept { bodies_.clear(); }

 private:
  static constexpr std::size_t kMost = 64;

  const btDiscreteDynamicsWorld& world_;
  std::vector<std::unique_ptr<HapticBody>> bodies_;
  int objects_ = 0;  ///< in the world, at the last look
};

}  // namespace tandem
