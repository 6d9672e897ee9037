#include "link/units.h"

#include <charconv>
#include <cmath>

namespace tandem::demos {
namespace {

struct Unit {
  std::string_view name;
  double per_si;  ///< dividing by a whole number rounds once: "50ms" is the double 0.05
};

/// Reads a number without sign and its unit, in SI.
template <std::size_t kCount>
std::optional<double> parseQuantity(std::string_view text, const Unit (&units)[kCount]) noexcept {
  const bool begins_well =
      !text.empty() && (text.front() == '.' || (text.front() >= '0' && text.front() <= '9'));
  if (!begins_well) return std::nullopt;
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  const std::string_view unit(rest, static_cast<std::size_t>(end - rest));
  for (const Unit& known : units)
    if (unit == known.name) return value / known.per_si;
  return std::nullopt;
}

std::optional<double> upTo(double most, std::optional<double> value) noexcept {
  return value && *value <= most ? value : std::nullopt;
}

}  // namespace

std::optional<double> parseSeconds(std::string_view text) noexcept {
  constexpr Unit kUnits[] = {{"", 1.0}, {"s", 1.0}, {"ms", 1e3}, {"us", 1e6}};
  return parseQuantity(text, kUnits);
}

std::optional<double> parseDelay(std::string_view text) noexcept {
  return upTo(kLongestDelay, parseSeconds(text));
}

std::optional<double> parseShare(std::string_view text) noexcept {
  constexpr Unit kUnits[] = {{"", 1.0}, {"%", 1e2}};
  return upTo(1.0, parseQuantity(text, kUnits));
}

}  // namespace tandem::demos
