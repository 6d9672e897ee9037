#pragma once

#include <vector>

#include "site/objects.h"

namespace tandem {

/// The shared objects, and a list of all bodies whose motion the island decides: these objects,
/// neighbours of the host's world, and proxies, always in this order.
class Bodies {
 public:
  std::vector<SharedObject> objects;

  /// Set-up, whenever a body has come: lists them anew. Allocates.
  void clearList() noexcept { all_.clear(); }
  void list(SiteBody& body) { all_.push_back(&body); }

  /// Calls `visit` with each body that the island holds. In the tick and in what is asked of it.
  template <typename Visit>
  void forEach(Visit visit) const {
    for (SiteBody* body : all_)
      if (body->is_held) visit(*body);
  }
  /// The same without bodies that are missing in the host's world. For the host's thread.
  template <typename Visit>
  void forEachPresent(Visit visit) const {
    for (SiteBody* body : all_)
      if (body->is_held && !body->is_leaving) visit(*body);
  }

 private:
  std::vector<SiteBody*> all_;
};

}  // namespace tandem
