#pragma once

#include <optional>
#include <utility>

#include "scenario/keys.h"

// One function for each kind of key. `member` finds the value in its owner, a Scenario unless said
// otherwise: a pointer to a member, or a lambda for what lies deeper.

namespace tandem::demos {

/// Text of the document on a key.
struct KeyText {
  std::string name;
  std::string meaning;
  std::string unit = {};
  std::string note = {};       ///< after the allowed values
  std::string otherwise = {};  ///< the default in words
};

constexpr double kMost = 1e9;  ///< of any number of a scenario
constexpr FieldRange kPositive{0.0, kMost, true, "a finite number above 0"};
constexpr FieldRange kNotNegative{0.0, kMost, false, "a finite number, 0 or more"};
constexpr FieldRange kProbability{0.0, 1.0, false, "a probability, 0 to 1"};

[[nodiscard]] double readNumber(const Place& place, const toml::node& node,
                                const FieldRange& range);
[[nodiscard]] Vec3 readVector(const Place& place, const toml::node& node);
[[nodiscard]] bool readFlag(const Place& place, const toml::node& node);
[[nodiscard]] std::string readString(const Place& place, const toml::node& node);
/// The place of the text in `choices`.
[[nodiscard]] std::size_t readChoice(const Place& place, const toml::node& node,
                                     const std::vector<std::string>& choices);

/// A key's allowed values, and its note after them.
[[nodiscard]] std::string joinNote(const std::string& allowed, const std::string& note);

/// A key without its functions; `allowed` stands before the note.
template <typename Owner = Scenario>
[[nodiscard]] KeyOf<Owner> makeKey(const KeyText& text, const std::string& allowed) {
  KeyOf<Owner> key;
  key.name = text.name;
  key.meaning = text.meaning;
  key.unit = text.unit;
  key.allowed = joinNote(allowed, text.note);
  key.otherwise = text.otherwise;
  return key;
}
/// "> 0", "10 to 100000"; as the document writes a range.
[[nodiscard]] std::string describeRange(const FieldRange& range);
/// "`a`, `b`".
[[nodiscard]] std::string describeChoices(const std::vector<std::string>& choices);

/// A field of the sites' settings, with its own name, unit and range.
[[nodiscard]] ScenarioKey siteKey(const char* field, const std::string& more = {});
/// The same under another name; `range` may be narrower than the field's.
[[nodiscard]] ScenarioKey siteKey(const char* name, const char* field, const FieldRange& range,
                                  const std::string& note = {});
[[nodiscard]] ScenarioKey siteFlagKey(const char* name, const char* field,
                                      const std::string& more = {});

[[nodiscard]] inline nlohmann::json toJson(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
template <typename Value>
[[nodiscard]] nlohmann::json toJson(const Value& value) {
  return value;
}
template <typename Value>
[[nodiscard]] nlohmann::json toJson(const std::optional<Value>& value) {
  return value ? toJson(*value) : nlohmann::json();
}

/// A key of the value that `read` makes of a node.
template <typename Owner = Scenario, typename Read, typename Member>
KeyOf<Owner> valueKey(const KeyText& text, const std::string& allowed, Read read, Member member) {
  auto key = makeKey<Owner>(text, allowed);
  key.read = [=](Owner& owner, const Place& place, const toml::node& node) {
    std::invoke(member, owner) = read(place, node);
  };
  key.show = [=](const Owner& owner) { return toJson(std::invoke(member, owner)); };
  return key;
}

template <typename Owner = Scenario, typename Member>
KeyOf<Owner> numberKey(const KeyText& text, const FieldRange& range, Member member) {
  const auto read = [range](const Place& place, const toml::node& node) {
    return readNumber(place, node, range);
  };
  return valueKey<Owner>(text, describeRange(range), read, member);
}

template <typename Owner = Scenario, typename Member>
KeyOf<Owner> vectorKey(const KeyText& text, Member member) {
  return valueKey<Owner>(text, "three numbers of at most 1e6", &readVector, member);
}

template <typename Owner = Scenario, typename Member>
KeyOf<Owner> textKey(const KeyText& text, Member member) {
  return valueKey<Owner>(text, "text", &readString, member);
}

template <typename Owner = Scenario, typename Member>
KeyOf<Owner> flagKey(const KeyText& text, Member member) {
  return valueKey<Owner>(text, "true, false", &readFlag, member);
}

/// A choice whose text itself is the value.
template <typename Owner = Scenario, typename Member>
KeyOf<Owner> choiceKey(const KeyText& text, const std::vector<std::string>& choices,
                       Member member) {
  const auto read = [choices](const Place& place, const toml::node& node) {
    return choices[readChoice(place, node, choices)];
  };
  return valueKey<Owner>(text, describeChoices(choices), read, member);
}

/// A choice between the values of an enumeration, which count from 0 in the order of `choices`.
template <typename Member>
ScenarioKey enumKey(const KeyText& text, std::vector<std::string> choices, Member member) {
  ScenarioKey key = makeKey(text, describeChoices(choices));
  key.read = [=](Scenario& s, const Place& place, const toml::node& node) {
    auto& value = std::invoke(member, s);
    value = static_cast<std::decay_t<decltype(value)>>(readChoice(place, node, choices));
  };
  key.show = [=](const Scenario& s) -> nlohmann::json {
    return choices[static_cast<std::size_t>(std::invoke(member, s))];
  };
  return key;
}

}  // namespace tandem::demos
