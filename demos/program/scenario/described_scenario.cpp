#include "scenario/described_scenario.h"

#include "tandem/plugin/toml_text.h"

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

/// Puts values of JSON into tables and arrays of TOML.
class Converter {
 public:
  explicit Converter(const std::string& name) : name_(name) {}

  [[nodiscard]] toml::table makeTable(const nlohmann::json& object, const nlohmann::json& defaults,
                                      int depth) const {
    toml::table table;
    for (const auto& [key, value] : object.items()) {
      const bool has_default = defaults.is_object() && defaults.contains(key);
      const nlohmann::json usual = has_default ? defaults[key] : nlohmann::json();
      if (has_default && value == usual) continue;
      convert(value, usual, depth + 1,
              [&, name = key](auto&& node) { table.insert_or_assign(name, node); });
    }
    return table;
  }

 private:
  [[nodiscard]] toml::array makeArray(const nlohmann::json& list, int depth) const {
    toml::array array;
    for (const nlohmann::json& value : list)
      convert(value, {}, depth + 1, [&](auto&& node) { array.push_back(node); });
    return array;
  }

  template <typename Store>
  void convert(const nlohmann::json& value, const nlohmann::json& defaults, int depth,
               const Store& store) const {
    if (depth > kDeepestToml || value.is_null())
      throw UsageError(name_ + ": the scenario is none of Tandem's; record the run again");
    if (value.is_object()) return store(makeTable(value, defaults, depth));
    if (value.is_array()) return store(makeArray(value, depth));
    if (value.is_string()) return store(value.get<std::string>());
    if (value.is_boolean()) return store(value.get<bool>());
    if (value.is_number_integer()) return store(value.get<std::int64_t>());
    store(value.get<double>());
  }

  const std::string& name_;
};

}  // namespace

toml::table makeToml(const nlohmann::json& described, const nlohmann::json& defaults,
                     const std::string& name) {
  if (!described.is_object())
    throw UsageError(name + ": the scenario is none of Tandem's; record the run again");
  return Converter(name).makeTable(described, defaults, 0);
}

}  // namespace tandem::demos
