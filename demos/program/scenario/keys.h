#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenario/scenario.h"
#include "scenario/toml_input.h"

namespace tandem::demos {

/// A key of a table of a scenario file, and its row in docs/scenarios.md. `Owner` holds its value.
template <typename Owner>
struct KeyOf {
  std::string name;
  std::string meaning;    ///< Markdown, as the other texts
  std::string unit;       ///< empty: none
  std::string allowed;    ///< values, and what else limits them
  std::string otherwise;  ///< the default in words; empty: as a new Scenario shows it
  bool is_own = false;    ///< two sites of one cooperation may differ in it
  /// Throws UsageError if the node is none of the allowed values.
  std::function<void(Owner&, const Place&, const toml::node&)> read;
  std::function<nlohmann::json(const Owner&)> show;
};

using ScenarioKey = KeyOf<Scenario>;

/// All keys in the order of the document.
[[nodiscard]] const std::vector<ScenarioKey>& scenarioKeys();

/// The word in a file, such as "native_soft".
[[nodiscard]] std::string nameOf(ContactModel model);

}  // namespace tandem::demos
