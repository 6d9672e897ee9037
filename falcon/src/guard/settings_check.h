#pragma once

#include <string>
#include <string_view>

#include "tandem/coordination/types.h"

namespace tandem::falcon_detail {

/// Shortest text that reads back as the same number. Independent of the locale.
[[nodiscard]] std::string toText(double value);

/// Text "[x, y, z]".
[[nodiscard]] std::string toText(const Vec3& value);

/// Throws std::invalid_argument "NAME is VALUE, must be ALLOWED" unless `is_allowed`.
void require(bool is_allowed, std::string_view name, double value, std::string_view allowed);
void require(bool is_allowed, std::string_view name, const Vec3& value, std::string_view allowed);

}  // namespace tandem::falcon_detail
