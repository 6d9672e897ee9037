#pragma once

#include <sstream>
#include <stdexcept>

namespace tandem {

/// Refuses a setting: throws std::invalid_argument "<name> = <value>: must be <allowed>".
template <typename Value>
[[noreturn]] void throwBadValue(const char* name, const Value& value, const char* allowed) {
  std::ostringstream message;
  message << name << " = " << value << ": must be " << allowed;
  throw std::invalid_argument(message.str());
}

}  // namespace tandem
