// The check before the TOML parser: any text is either refused or parsed, and a parsed tree is no
// deeper than the check says. Headers below an array of tables may nest twice as deep.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "tandem/plugin/toml_text.h"

namespace tandem {
namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

int measureBelow(const toml::node& node) {
  int most = 0;
  if (const auto* table = node.as_table())
    for (const auto& [key, value] : *table) most = std::max(most, 1 + measureBelow(value));
  if (const auto* array = node.as_array())
    for (const toml::node& value : *array) most = std::max(most, 1 + measureBelow(value));
  return most;
}

void check(std::string_view text, int most) {
  if (findDeepToml(text, most)) return;
  try {
    require(measureBelow(toml::parse(text)) <= 2 * most);
  } catch (const toml::parse_error&) {
  }
}

}  // namespace
}  // namespace tandem

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  // A small limit is within reach of short inputs.
  for (const int most : {2, 5, tandem::kDeepestToml}) tandem::check(text, most);
  return 0;
}
