#pragma once

#include <memory>
#include <vector>

#include "tandem/coordination/link.h"

#include "site/site_body.h"

class btRigidBody;

namespace tandem {

/// A body of the host that all peers have a copy of.
struct SharedObject {
  btRigidBody* rigid = nullptr;        ///< the host's
  std::unique_ptr<HapticBody> bullet;  ///< what `body` points to
  SiteBody body;
  ObjectId id = 0;
  double damping = 0.0;  ///< of this copy [N s/m]
  double bounding_radius = 0.0;
};

}  // namespace tandem
