#include "guard/settings_check.h"

#include <array>
#include <charconv>
#include <stdexcept>

namespace tandem::falcon_detail {
namespace {

[[noreturn]] void refuse(std::string_view name, const std::string& value,
                         std::string_view allowed) {
  std::string message(name);
  message.append(" is ").append(value).append(", must be ").append(allowed);
  throw std::invalid_argument(message);
}

}  // namespace

std::string toText(double value) {
  std::array<char, 32> buffer{};  // the shortest exact text of a double has at most 24 characters
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string toText(const Vec3& value) {
  return "[" + toText(value.x()) + ", " + toText(value.y()) + ", " + toText(value.z()) + "]";
}

void require(bool is_allowed, std::string_view name, double value, std::string_view allowed) {
  if (!is_allowed) refuse(name, toText(value), allowed);
}

void require(bool is_allowed, std::string_view name, const Vec3& value, std::string_view allowed) {
  if (!is_allowed) refuse(name, toText(value), allowed);
}

}  // namespace tandem::falcon_detail
