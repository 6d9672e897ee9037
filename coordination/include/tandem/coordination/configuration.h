#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// What peers must have the same before anything is coupled, as named items (section 8 of
/// coordination/STANDARD.md). For set-up: these functions allocate.
#pragma GCC visibility push(default)
namespace tandem {

/// One named value, both as text: "object.mass", "0.2".
struct ConfigurationItem {
  std::string key;
  std::string value;

  [[nodiscard]] friend bool operator==(const ConfigurationItem& a, const ConfigurationItem& b) {
    return a.key == b.key && a.value == b.value;
  }
};

/// Items in rising order of their keys.
using Configuration = std::vector<ConfigurationItem>;

/// 1 to 64 characters of A-Z a-z 0-9 . _ -
[[nodiscard]] bool isConfigurationKey(std::string_view key) noexcept;

/// 1 to 255 bytes of UTF-8 without control characters.
[[nodiscard]] bool isConfigurationValue(std::string_view value) noexcept;

/// The items, sorted. Throws std::invalid_argument, with key and value, if one is no item or a key
/// is there twice.
[[nodiscard]] Configuration makeConfiguration(std::vector<ConfigurationItem> items);

/// Equal for equal configurations; finds differences, proves nothing.
[[nodiscard]] std::uint32_t hashConfiguration(const Configuration& configuration) noexcept;

/// An item that two peers do not have alike; a value is empty where there is none.
struct ConfigurationDifference {
  std::string key;
  std::string here;
  std::string there;
};

/// The difference with the lowest key; nothing if there is none.
[[nodiscard]] std::optional<ConfigurationDifference> findFirstDifference(
    const Configuration& here, const Configuration& there);

}  // namespace tandem
#pragma GCC visibility pop
