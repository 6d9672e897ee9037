#pragma once

#include <map>
#include <memory>
#include <mutex>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

namespace tandem {

/// The one `Guest` that all sites have in a dispatcher: a host may give one dispatcher to several
/// worlds. Made for the first who asks, and destroyed with the last who keeps it. Sites may ask in
/// any thread; those of one dispatcher share a thread, as Bullet demands.
template <typename Guest>
[[nodiscard]] std::shared_ptr<Guest> guestOf(btCollisionDispatcher& dispatcher) {
  static std::mutex mutex;
  static auto& guests = *new std::map<btCollisionDispatcher*, std::weak_ptr<Guest>>;
  const std::lock_guard lock(mutex);
  std::erase_if(guests, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<Guest>& known = guests[&dispatcher];
  if (std::shared_ptr<Guest> guest = known.lock()) return guest;
  auto guest = std::make_shared<Guest>(dispatcher);
  known = guest;
  return guest;
}

}  // namespace tandem
