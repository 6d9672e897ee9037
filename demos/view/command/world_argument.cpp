#include "command/world_argument.h"

#include <fmt/ranges.h>

#include "session/own_worlds.h"
#include "terminal/usage_error.h"

namespace tandem::view {

std::filesystem::path findWorld(const std::string& argument) {
  std::error_code ignored;
  if (const auto own = findOwnWorld(argument)) return *own;
  if (std::filesystem::exists(argument, ignored)) return argument;
  throw demos::UsageError(fmt::format("{}: there is no such file or world; worlds: {}", argument,
                                      fmt::join(listWorlds(), ", ")));
}

}  // namespace tandem::view
