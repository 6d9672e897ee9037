#pragma once

#include <optional>

#include "tandem/coordination/coupling_settings.h"
#include "tandem/coordination/scheme.h"

#include "island/island.h"

namespace tandem {

/// A remote user at this site: what a scheme made of it in the island.
struct RemoteUser {
  std::optional<BodyIndex> body;        ///< nothing: the user is felt through shared objects only
  std::optional<CouplerIndex> coupler;  ///< ties a dynamic body to the user's delayed state
};

}  // namespace tandem
