#pragma once

class btCollisionObject;
class btDiscreteDynamicsWorld;

namespace tandem {

/// True if the host lets the two objects touch: by groups, masks and ignored pairs, by an overlap
/// filter callback, and by needsCollision() and needsResponse() of a dispatcher class of its own.
/// Host code runs in this call. Both are in the world; in the host's thread.
[[nodiscard]] bool hostLetsTouch(btDiscreteDynamicsWorld& host, const btCollisionObject& a,
                                 const btCollisionObject& b);

/// True if Bullet lets the two touch although one of them ignores the other: a dispatcher class of
/// the host's does not ask that list. Then their contact cannot be filtered.
[[nodiscard]] bool mindsNoFilter(btDiscreteDynamicsWorld& host, const btCollisionObject& a,
                                 const btCollisionObject& b);

/// True if code of the host answers hostLetsTouch(): the answer may change without any notice.
[[nodiscard]] bool hasOwnFilter(btDiscreteDynamicsWorld& host);

/// True if the host has a near callback of its own. It decides on each pair in each step, and
/// cannot be asked without doing Bullet's work: contact stays Bullet's.
#pragma GCC visibility push(default)
[[nodiscard]] bool hasOwnNearCallback(btDiscreteDynamicsWorld& host);
#pragma GCC visibility pop

}  // namespace tandem
