#include "bodies/sleep_watch.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "bodies/body_number.h"
#include "bodies/haptic_body.h"

namespace tandem {
namespace {

using Lanes = std::uint64_t __attribute__((vector_size(16)));
constexpr std::size_t kLanes = sizeof(Lanes);

Lanes readLanes(const void* value, std::size_t at) noexcept {
  Lanes lanes;
  std::memcpy(&lanes, static_cast<const char*>(value) + at, kLanes);
  return lanes;
}

/// Differences of bits, 16 bytes at a time.
class BitDifference {
 public:
  template <typename Value>
  void compare(const Value& a, const Value& b) noexcept {
    static_assert(sizeof(Value) % kLanes == 0);
    for (std::size_t at = 0; at < sizeof(Value); at += kLanes)
      bits_ |= readLanes(&a, at) ^ readLanes(&b, at);
  }
  [[nodiscard]] bool isNone() const noexcept { return (bits_[0] | bits_[1]) == 0; }

 private:
  Lanes bits_{};
};

/// True if all are zero, of either sign: bits set in any of them make a number that is not zero.
template <typename... Vectors>
bool areAllZero(const Vectors&... vectors) noexcept {
  alignas(kLanes) btScalar merged[4];
  static_assert(sizeof merged == sizeof(btVector3));
  for (std::size_t at = 0; at < sizeof merged; at += kLanes) {
    Lanes lanes{};
    ((lanes |= readLanes(&vectors, at)), ...);
    std::memcpy(reinterpret_cast<char*>(merged) + at, &lanes, kLanes);
  }
  return merged[0] == 0 && merged[1] == 0 && merged[2] == 0;
}

}  // namespace

bool SleepWatch::remember(const std::vector<HapticBody*>& bodies) {
  looks_.clear();
  shapes_.clear();
  for (const HapticBody* haptic : bodies) {
    const btRigidBody& body = haptic->body();
    const btBroadphaseProxy* proxy = body.getBroadphaseHandle();
    if (!haptic->isInWorld() || proxy == nullptr || !haptic->isUndisturbed()) {
      looks_.clear();
      return false;
    }
    const int& number = numberOf(body);
    looks_.push_back({&body,
                      proxy,
                      body.getCollisionShape(),
                      &number,
                      body.getWorldArrayIndex(),
                      number,
                      proxy->m_uniqueId,
                      proxy->m_collisionFilterGroup,
                      proxy->m_collisionFilterMask,
                      body.getCollisionFlags(),
                      body.getInvMass(),
                      body.getFriction(),
                      body.getRestitution(),
                      body.getRollingFriction(),
                      body.getSpinningFriction(),
                      body.getWorldTransform(),
                      body.getGravity(),
                      body.getInvInertiaDiagLocal(),
                      body.getLinearFactor(),
                      body.getAngularFactor()});
    const btCollisionShape& shape = *body.getCollisionShape();
    const auto is_known = [&](const ShapeLook& other) { return other.shape == &shape; };
    if (std::none_of(shapes_.begin(), shapes_.end(), is_known))
      shapes_.push_back({&shape, shape.getMargin(), shape.getLocalScaling()});
  }
  return true;
}

bool SleepWatch::Look::isUnchanged() const noexcept {
  const btRigidBody& now = *body;
  if (now.getBroadphaseHandle() != proxy || now.getActivationState() != ISLAND_SLEEPING)
    return false;
  BitDifference difference;
  difference.compare(now.getWorldTransform(), pose);
  difference.compare(now.getGravity(), gravity);
  difference.compare(now.getInvInertiaDiagLocal(), inverse_inertia);
  difference.compare(now.getLinearFactor(), linear_factor);
  difference.compare(now.getAngularFactor(), angular_factor);
  const int other = (*number_in_body ^ number) | (proxy->m_uniqueId ^ broadphase_id) |
                    (proxy->m_collisionFilterGroup ^ group) |
                    (proxy->m_collisionFilterMask ^ mask) | (now.getCollisionFlags() ^ flags);
  // The forces of a sleeping body do not include its weight.
  const bool is_still = areAllZero(now.getTotalForce(), now.getTotalTorque(),
                                   now.getLinearVelocity(), now.getAngularVelocity());
  const bool has_its_surface = now.getFriction() == friction &&
                               now.getRestitution() == restitution &&
                               now.getRollingFriction() == rolling_friction &&
                               now.getSpinningFriction() == spinning_friction;
  return difference.isNone() && other == 0 && is_still && has_its_surface &&
         now.getInvMass() == inverse_mass && now.getCollisionShape() == shape;
}

bool SleepWatch::isUndisturbed() const noexcept {
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  for (const Look& look : looks_)
    if (look.world_index >= objects.size() || objects[look.world_index] != look.body ||
        !look.isUnchanged())
      return false;
  // These shapes are in use: all bodies have been found with theirs.
  return std::all_of(shapes_.begin(), shapes_.end(), [](const ShapeLook& look) {
    return look.shape->getMargin() == look.margin &&
           equalBits(look.shape->getLocalScaling(), look.scaling);
  });
}

bool SleepWatch::areAsleep() const noexcept {
  return std::none_of(looks_.begin(), looks_.end(),
                      [](const Look& look) { return look.body->isActive(); });
}

}  // namespace tandem
