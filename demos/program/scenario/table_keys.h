#pragma once

#include <algorithm>

#include <fmt/format.h>

#include "scenario/key_kinds.h"

// Lists of tables in a scenario, such as [[body]], each with keys of its own.

namespace tandem::demos {

/// Throws UsageError that names the allowed keys.
[[noreturn]] void refuseKey(const Place& place, const toml::node& node,
                            const std::vector<std::string>& allowed);

/// Reads a table that `place.key` names.
template <typename Owner>
void readTable(const std::vector<KeyOf<Owner>>& keys, Owner& owner, const Place& place,
               const toml::table& table) {
  for (const auto& [name, node] : table) {
    const Place at{place.file, place.key + "." + std::string(name.str())};
    const auto key = std::ranges::find(keys, std::string(name.str()), &KeyOf<Owner>::name);
    if (key == keys.end()) {
      std::vector<std::string> allowed;
      for (const KeyOf<Owner>& one : keys) allowed.push_back(one.name);
      refuseKey(at, node, allowed);
    }
    key->read(owner, at, node);
  }
}

/// Reads a list of at most `most` tables. One with a name is called by it in messages.
template <typename Owner>
std::vector<Owner> readTables(const std::vector<KeyOf<Owner>>& keys, const Place& place,
                              const toml::node& node, std::size_t most) {
  const std::string allowed = fmt::format("a list of at most {} tables, [[{}]]", most, place.key);
  const toml::array* tables = node.as_array();
  if (!tables || tables->size() > most) refuse(place, node, allowed);
  std::vector<Owner> owners;
  for (const toml::node& one : *tables) {
    const toml::table* table = one.as_table();
    if (!table) refuse(place, one, allowed);
    const auto name = (*table)["name"].value<std::string>();
    const std::string which = name ? *name : std::to_string(owners.size() + 1);
    readTable(keys, owners.emplace_back(), {place.file, place.key + '.' + which}, *table);
  }
  return owners;
}

/// The table's keys with their values, without those that have none.
template <typename Owner>
nlohmann::json showTable(const std::vector<KeyOf<Owner>>& keys, const Owner& owner) {
  nlohmann::json table = nlohmann::json::object();
  for (const KeyOf<Owner>& key : keys) {
    nlohmann::json value = key.show(owner);
    if (!value.is_null() && value != "" && value != nlohmann::json::array())
      table[key.name] = value;
  }
  return table;
}

template <typename Owner>
nlohmann::json showTables(const std::vector<KeyOf<Owner>>& keys, const std::vector<Owner>& owners) {
  nlohmann::json tables = nlohmann::json::array();
  for (const Owner& owner : owners) tables.push_back(showTable(keys, owner));
  return tables;
}

/// A key for a list of tables with `keys`.
template <typename Owner = Scenario, typename Part, typename Member>
KeyOf<Owner> tablesKey(const KeyText& text, const std::vector<KeyOf<Part>>& keys, std::size_t most,
                       Member member) {
  auto key = makeKey<Owner>(text, fmt::format("at most {}", most));
  key.read = [&keys, most, member](Owner& owner, const Place& place, const toml::node& node) {
    std::invoke(member, owner) = readTables(keys, place, node, most);
  };
  key.show = [&keys, member](const Owner& owner) {
    return showTables(keys, std::invoke(member, owner));
  };
  return key;
}

}  // namespace tandem::demos
