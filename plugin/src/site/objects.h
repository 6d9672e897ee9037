#pragma once

#include <memory>
#include <vector>

#include "tandem/coordination/link.h"

#include "site/site_body.h"

class btRigidBody;

namespace tandem {

/// A body of the host of which every peer has a copy.
struct SharedObject {
  btRigidBody* rigid = nullptr;        ///< the host's body
  std::unique_ptr<HapticBody> bullet;  ///< `body` points to it
  SiteBody body;
  ObjectId id = 0;
  double damping = 0.0;  ///< of this copy [N s/m]
  double bounding_radius = 0.0;
};

}  // namespace tandem
