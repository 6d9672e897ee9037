#include "tandem/coordination/configuration.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

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

/// FNV-1a hash, 64 bits.
class Fnv {
 public:
  void add(std::string_view text) noexcept {
    for (const char c : text)
      hash_ = (hash_ ^ static_cast<unsigned char>(c)) * std::uint64_t{0x100000001b3};
  }

  [[nodiscard]] std::uint32_t folded() const noexcept {
    return static_cast<std::uint32_t>(hash_ >> 32 ^ (hash_ & 0xffffffffU));
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

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
  for (const ConfigurationItem& item : configuration) {
    hash.add(item.key);
    hash.add("=");
    hash.add(item.value);
    hash.add("\n");
  }
  return hash.folded();
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
