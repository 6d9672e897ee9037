#pragma once

#include <optional>

#include "tandem/coordination/coupling_settings.h"
#include "tandem/coordination/scheme.h"

#include "island/island.h"

namespace tandem {

/// Representation of a remote user in the local island, made by a scheme.
struct RemoteUser {
  std::optional<BodyIndex> body;        ///< empty: the user is felt only through shared objects
  std::optional<CouplerIndex> coupler;  ///< couples a dynamic body to the user's delayed state
};

}  // namespace tandem
