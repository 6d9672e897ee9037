#include "link/link_script.h"

#include <cmath>
#include <functional>
#include <map>

#include <fmt/format.h>

#include "link/units.h"
#include "scenario/toml_input.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr double kLatest = 1e6;  // [s]

using Parse = std::optional<double> (*)(std::string_view) noexcept;
using Reader = std::function<void(LinkChange&, const Place&, const toml::node&)>;

/// Reads a text with a unit, or a number in SI units.
double readQuantity(const Place& place, const toml::node& node, Parse parse, double most,
                    const char* allowed) {
  std::optional<double> value;
  if (const auto* text = node.as_string()) value = parse(text->get());
  if (node.is_number()) value = node.value<double>();
  if (!value || !(*value >= 0.0 && *value <= most)) refuse(place, node, allowed);
  return *value;
}

Reader delayKey(std::optional<double> LinkChange::*field) {
  return [field](LinkChange& change, const Place& place, const toml::node& node) {
    change.*field = readQuantity(place, node, parseDelay, kLongestDelay, kAllowedDelay);
  };
}

Reader shareKey(std::optional<double> LinkChange::*field) {
  return [field](LinkChange& change, const Place& place, const toml::node& node) {
    change.*field = readQuantity(place, node, parseShare, 1.0, kAllowedShare);
  };
}

template <typename Flag>
Reader flagKey(Flag LinkChange::*field) {
  return [field](LinkChange& change, const Place& place, const toml::node& node) {
    const auto* flag = node.as_boolean();
    if (!flag) refuse(place, node, "true or false");
    change.*field = flag->get();
  };
}

void readAt(LinkChange& change, const Place& place, const toml::node& node) {
  change.at = readQuantity(place, node, parseSeconds, kLatest,
                           "seconds after the start, 0 to 1e6, such as 5.0 or \"500ms\"");
}

void readCut(LinkChange& change, const Place& place, const toml::node& node) {
  const std::map<std::string, LinkCut> cuts = {
      {"none", LinkCut::kNone}, {"forward", LinkCut::kForward}, {"back", LinkCut::kBack}};
  const auto* text = node.as_string();
  const auto cut = text ? cuts.find(text->get()) : cuts.end();
  if (cut == cuts.end()) refuse(place, node, "one of \"forward\", \"back\", \"none\"");
  change.cut = cut->second;
}

const std::map<std::string, Reader>& allKeys() {
  using C = LinkChange;
  static const std::map<std::string, Reader> keys = {
      {"at", readAt},
      {"delay", delayKey(&C::delay)},
      {"jitter", delayKey(&C::jitter)},
      {"loss", shareKey(&C::loss)},
      {"duplicate", shareKey(&C::duplicate)},
      {"reorder", shareKey(&C::reorder)},
      {"corrupt", shareKey(&C::corrupt)},
      {"keep_order", flagKey(&C::keep_order)},
      {"outage", flagKey(&C::outage)},
      {"rebind", flagKey(&C::rebind)},
      {"cut", readCut},
  };
  return keys;
}

LinkChange readChange(const std::string& file, const std::string& where, const toml::table& table) {
  LinkChange change;
  for (const auto& [name, node] : table) {
    const Place place{file, where + "." + std::string(name.str())};
    const auto key = allKeys().find(std::string(name.str()));
    if (key == allKeys().end()) {
      std::vector<std::string> names;
      for (const auto& [known, reader] : allKeys()) names.push_back(known);
      throw UsageError(fmt::format("{}: {} = {}: there is no such key; allowed: {}", file,
                                   place.key, show(node), fmt::join(names, ", ")));
    }
    key->second(change, place, node);
  }
  if (!table.contains("at"))
    throw UsageError(
        fmt::format("{}: {}.at is missing; must be seconds after the start", file, where));
  return change;
}

}  // namespace

std::vector<LinkChange> parseLinkScript(const std::string& text, const std::string& name) {
  const toml::table script = parseToml(text, name);
  for (const auto& [key, node] : script)
    if (key.str() != "change")
      throw UsageError(fmt::format("{}: {} = {}: there is no such key; allowed: [[change]]", name,
                                   std::string(key.str()), show(node)));
  const toml::node* list = script.get("change");
  if (!list) throw UsageError(name + ": holds no [[change]]; a script must have one or more");
  const toml::array* tables = list->as_array();
  if (!tables) refuse({name, "change"}, *list, "tables headed [[change]], with two brackets");

  std::vector<LinkChange> changes;
  for (const toml::node& node : *tables) {
    const std::string where = fmt::format("change {}", changes.size() + 1);
    const toml::table* table = node.as_table();
    if (!table) refuse({name, where}, node, "a table headed [[change]]");
    const LinkChange change = readChange(name, where, *table);
    if (!changes.empty() && change.at < changes.back().at)
      refuse({name, where + ".at"}, *table->get("at"),
             fmt::format("at or after the change before it, {} s", changes.back().at));
    changes.push_back(change);
  }
  return changes;
}

std::vector<LinkChange> loadLinkScript(const std::filesystem::path& file) {
  return parseLinkScript(readText(file, "script"), file.string());
}

}  // namespace tandem::demos
