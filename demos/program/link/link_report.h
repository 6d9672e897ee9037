#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "link/link_proxy.h"

namespace tandem::demos {

/// Asked against achieved, per direction: shares 0 to 1, times in seconds, null where no datagram
/// applies.
[[nodiscard]] nlohmann::json makeLinkReport(const LinkProxy& proxy);

/// The same as a table for people.
[[nodiscard]] std::string formatLinkReport(const nlohmann::json& report);

}  // namespace tandem::demos
