#include "scenario/table_keys.h"

#include "terminal/usage_error.h"

namespace tandem::demos {

void refuseKey(const Place& place, const toml::node& node,
               const std::vector<std::string>& allowed) {
  throw UsageError(fmt::format("{} = {}: there is no such key; allowed: {}",
                               describePlace(place, node), show(node), fmt::join(allowed, ", ")));
}

}  // namespace tandem::demos
