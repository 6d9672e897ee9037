#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Named settings that all peers must share before they are coupled
/// (coordination/STANDARD.md, section 8). For set-up only: these functions allocate.
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

/// True for 1 to 64 characters of A-Z a-z 0-9 . _ -
[[nodiscard]] bool isConfigurationKey(std::string_view key) noexcept;

/// True for 1 to 255 bytes of UTF-8 without control characters.
[[nodiscard]] bool isConfigurationValue(std::string_view value) noexcept;

/// Sorts the items by key. Throws std::invalid_argument, with key and value, if an item is invalid
/// or a key occurs twice.
[[nodiscard]] Configuration makeConfiguration(std::vector<ConfigurationItem> items);

/// Hash that is equal for equal configurations. It finds differences but proves nothing.
[[nodiscard]] std::uint32_t hashConfiguration(const Configuration& configuration) noexcept;

/// An item that differs between two peers; a value is empty where the key is missing.
struct ConfigurationDifference {
  std::string key;
  std::string here;
  std::string there;
};

/// The difference with the lowest key; nothing if the configurations are equal.
[[nodiscard]] std::optional<ConfigurationDifference> findFirstDifference(
    const Configuration& here, const Configuration& there);

}  // namespace tandem
#pragma GCC visibility pop
