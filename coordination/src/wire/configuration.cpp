#include "tandem/coordination/configuration.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "fnv.h"
#include "wire/utf8.h"

namespace tandem {
namespace {

constexpr std::size_t kMaxKeyLength = 64;
constexpr std::size_t kMaxValueLength = 255;

bool isKeyCharacter(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '_' || c == '-';
}

void requireItem(const ConfigurationItem& item) {
  if (!isConfigurationKey(item.key)) {
    throw std::invalid_argument("configuration key '" + item.key +
                                "': must be 1 to 64 of A-Z a-z 0-9 . _ -");
  }
  if (!isConfigurationValue(item.value)) {
    throw std::invalid_argument("configuration value of '" + item.key +
                                "': must be 1 to 255 bytes of UTF-8 without control characters");
  }
}

}  // namespace

bool isConfigurationKey(std::string_view key) noexcept {
  return !key.empty() && key.size() <= kMaxKeyLength &&
         std::all_of(key.begin(), key.end(), &isKeyCharacter);
}

bool isConfigurationValue(std::string_view value) noexcept {
  return !value.empty() && value.size() <= kMaxValueLength && wire::isPrintable(value);
}

Configuration makeConfiguration(std::vector<ConfigurationItem> items) {
  std::for_each(items.begin(), items.end(), &requireItem);
  std::sort(items.begin(), items.end(),
            [](const ConfigurationItem& a, const ConfigurationItem& b) { return a.key < b.key; });
  const auto twice = std::adjacent_find(
      items.begin(), items.end(),
      [](const ConfigurationItem& a, const ConfigurationItem& b) { return a.key == b.key; });
  if (twice != items.end())
    throw std::invalid_argument("configuration key '" + twice->key + "' is there twice");
  return items;
}

std::uint32_t hashConfiguration(const Configuration& configuration) noexcept {
  Fnv hash;
  const auto add = [&](std::string_view text) { hash.addBytes(text.data(), text.size()); };
  for (const ConfigurationItem& item : configuration) {
    add(item.key);
    add("=");
    add(item.value);
    add("\n");
  }
  return static_cast<std::uint32_t>(hash.value() >> 32 ^ (hash.value() & 0xffffffffU));
}

std::optional<ConfigurationDifference> findFirstDifference(const Configuration& here,
                                                           const Configuration& there) {
  const auto [a, b] = std::mismatch(here.begin(), here.end(), there.begin(), there.end());
  if (a == here.end() && b == there.end()) return std::nullopt;
  if (b == there.end() || (a != here.end() && a->key < b->key))
    return ConfigurationDifference{a->key, a->value, {}};
  if (a == here.end() || b->key < a->key) return ConfigurationDifference{b->key, {}, b->value};
  return ConfigurationDifference{a->key, a->value, b->value};
}

}  // namespace tandem
