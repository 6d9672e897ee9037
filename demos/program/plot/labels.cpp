#include "plot/labels.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tandem/coordination/scheme.h"

namespace tandem::demos::plot {
namespace {

struct Unit {
  std::string_view pointer;
  std::string_view label;
  std::string_view unit;
};

constexpr Unit kUnits[] = {
    {"/experiment/duration", "duration", "s"},
    {"/contact/stiffness", "contact stiffness", "N/m"},
    {"/contact/damping", "contact damping", "N s/m"},
    {"/coordination/stiffness", "coordination stiffness", "N/m"},
    {"/coordination/damping", "coordination damping", "N s/m"},
    {"/object/mass", "object mass", "kg"},
    {"/object/damping", "object damping", "N s/m"},
    {"/object/size", "object size", "m"},
    {"/proxy/mass", "proxy mass", "kg"},
    {"/proxy/damping", "proxy damping", "N s/m"},
    {"/proxy/radius", "proxy radius", "m"},
    {"/device/mass", "device mass", "kg"},
    {"/device/damping", "device damping", "N s/m"},
    {"/network/delay", "network delay", "s"},
    {"/network/rate", "packet rate", "Hz"},
    {"/network/jitter", "network jitter", "s"},
    {"/rates/haptic", "haptic rate", "Hz"},
    {"/rates/host", "host rate", "Hz"},
};

}  // namespace

const std::vector<std::string>& knownSchemes() {
  static const std::vector<std::string> schemes = [] {
    std::vector<std::string> names = {"virtual_coupling", "kinematic_proxy",
                                      "remote_dynamic_proxy"};
    for (const Scheme* scheme : allSchemes())
      if (std::find(names.begin(), names.end(), scheme->name()) == names.end())
        names.emplace_back(scheme->name());
    return names;
  }();
  return schemes;
}

bool isKnownScheme(std::string_view scheme) { return schemeRank(scheme) < knownSchemes().size(); }

std::size_t schemeRank(std::string_view scheme) {
  const auto& schemes = knownSchemes();
  return static_cast<std::size_t>(std::find(schemes.begin(), schemes.end(), scheme) -
                                  schemes.begin());
}

std::string schemeLabel(std::string_view scheme) {
  std::string label(scheme);
  std::replace(label.begin(), label.end(), '_', ' ');
  return label;
}

std::string_view schemeColour(std::string_view scheme) {
  constexpr std::array<std::string_view, 5> kColours = {"#e69f00", "#0072b2", "#009e73", "#d55e00",
                                                        "#000000"};
  return kColours[std::min(schemeRank(scheme), kColours.size() - 1)];
}

int schemePoint(std::string_view scheme) {
  constexpr std::array<int, 4> kPoints = {5, 9, 7, 2};  // square, triangle, disc; cross for others
  return kPoints[std::min(schemeRank(scheme), kPoints.size() - 1)];
}

std::string_view bodyColour(const SceneBody& body) {
  if (body.role == "device") return body.site == 1 ? kUser1Colour : kUser2Colour;
  if (body.role == "proxy") return body.site == 1 ? kUser2Colour : kUser1Colour;
  if (body.role == "object") return "#f0c800";
  if (body.role == "neighbour") return "#56b4e9";
  return "#b8b8b8";
}

std::string settingText(const std::string& pointer, const nlohmann::json& value) {
  std::string label = pointer.substr(1);
  std::replace(label.begin(), label.end(), '/', ' ');
  std::replace(label.begin(), label.end(), '_', ' ');
  std::string unit;
  for (const Unit& known : kUnits)
    if (known.pointer == pointer) {
      label = known.label;
      unit = fmt::format(" {}", known.unit);
    }
  if (value.is_number()) return fmt::format("{} {:g}{}", label, value.get<double>(), unit);
  if (value.is_string()) return fmt::format("{} {}", label, value.get<std::string>());
  if (value.is_null()) return fmt::format("{} not set", label);
  return fmt::format("{} {}", label, value.dump());
}

std::string numberText(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  if (value == 0.0) return "0";
  const int magnitude = static_cast<int>(std::floor(std::log10(std::abs(value))));
  return fmt::format("{:.{}f}", value, std::clamp(digits - 1 - magnitude, 0, 9));
}

std::string fixedText(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "–";
}

std::string joinWords(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return text;
}

}  // namespace tandem::demos::plot
