#pragma once

#include <vector>

#include "site/objects.h"

namespace tandem {

/// Owns the shared objects and lists all bodies whose motion the island decides. The list order is
/// fixed: objects, neighbours of the host's world, proxies.
class Bodies {
 public:
  std::vector<SharedObject> objects;

  /// Set-up: the list is built anew whenever a body is added. Allocates.
  void clearList() noexcept { all_.clear(); }
  void list(SiteBody& body) { all_.push_back(&body); }

  /// Calls `visit` with each body that the island holds. For the tick, and for work that the host's
  /// thread hands to it.
  template <typename Visit>
  void forEach(Visit visit) const {
    for (SiteBody* body : all_)
      if (body->is_held) visit(*body);
  }
  /// Like forEach(), but skips bodies that are missing in the host's world. For the host's thread.
  template <typename Visit>
  void forEachPresent(Visit visit) const {
    for (SiteBody* body : all_)
      if (body->is_held && !body->is_leaving) visit(*body);
  }

 private:
  std::vector<SiteBody*> all_;
};

}  // namespace tandem
