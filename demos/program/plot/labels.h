#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plot/run.h"

/// \file
/// Words and colours that every figure and table of a report shares. The colours are from the
/// Okabe-Ito set, which stays apart under the common kinds of colour blindness.
namespace tandem::demos::plot {

/// All schemes, by name: the paper's three in its order, then the others that were built in.
[[nodiscard]] const std::vector<std::string>& knownSchemes();

inline constexpr std::string_view kUser1Colour = "#444444";
inline constexpr std::string_view kUser2Colour = "#cc79a7";

[[nodiscard]] bool isKnownScheme(std::string_view scheme);

/// Place in knownSchemes(); sorts runs.
[[nodiscard]] std::size_t schemeRank(std::string_view scheme);

/// "remote dynamic proxy" for `remote_dynamic_proxy`.
[[nodiscard]] std::string schemeLabel(std::string_view scheme);
[[nodiscard]] std::string_view schemeColour(std::string_view scheme);
/// gnuplot's number of a point symbol: the schemes differ in shape as well as in colour.
[[nodiscard]] int schemePoint(std::string_view scheme);

/// Fill colour of a body: users keep theirs at both sites, whether as device or as proxy.
[[nodiscard]] std::string_view bodyColour(const SceneBody& body);

/// A setting as text with its unit: "network delay 0.2 s" for "/network/delay".
[[nodiscard]] std::string settingText(const std::string& pointer, const nlohmann::json& value);

/// `value` with `digits` significant digits, no exponent; "–" for NaN.
[[nodiscard]] std::string numberText(double value, int digits = 3);
/// As numberText() with a fixed number of decimals.
[[nodiscard]] std::string fixedText(double value, int decimals);

/// "a", "a and b", "a, b and c".
[[nodiscard]] std::string joinWords(const std::vector<std::string>& words);

}  // namespace tandem::demos::plot
