#pragma once

#include <stdexcept>
#include <string>

namespace tandem::test {

/// The message of `check` for default settings that `spoil` has changed; "" if it accepts them.
template <typename Settings, typename Spoil>
std::string refusalOf(void (*check)(const Settings&), Spoil spoil) {
  Settings settings;
  spoil(settings);
  try {
    check(settings);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace tandem::test
