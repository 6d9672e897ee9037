#pragma once

#include <string>

namespace tandem::demos::bench {

class GuestSite;

/// After a site's end: puts its bodies into a fresh world, gives the twin's bodies the same state
/// in another, and steps both. Tells the first body that differs, or nothing.
[[nodiscard]] std::string compareFreshWorlds(GuestSite& site);

}  // namespace tandem::demos::bench
