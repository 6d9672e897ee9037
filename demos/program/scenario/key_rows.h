#pragma once

#include <array>
#include <vector>

#include "scenario/key_kinds.h"

namespace tandem::demos {

/// Lists of `count` numbers each. An empty list is one too.
template <std::size_t count>
std::vector<std::array<double, count>> readRows(const Place& place, const toml::node& node,
                                                const FieldRange& range) {
  const toml::array* rows = node.as_array();
  if (!rows) refuse(place, node, range.allowed);
  std::vector<std::array<double, count>> read;
  for (const toml::node& row : *rows) {
    const toml::array* values = row.as_array();
    if (!values || values->size() != count) refuse(place, node, range.allowed);
    std::array<double, count>& numbers = read.emplace_back();
    for (std::size_t i = 0; i < count; ++i) numbers[i] = readNumber(place, (*values)[i], range);
  }
  return read;
}

}  // namespace tandem::demos
