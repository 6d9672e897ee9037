#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tandem/coordination/shape.h"

namespace tandem::preload {

/// A shape as a config names it: "box 0.1 0.1 0.2", "sphere 0.05", or without sizes "box".
struct ShapeWords {
  std::string kind;           ///< box, sphere, capsule, cylinder, hull
  std::vector<double> sizes;  ///< [m]; empty: any
};

/// The words of a text; nothing if they name no shape or not its number of sizes.
[[nodiscard]] std::optional<ShapeWords> parseShapeWords(const std::string& text);

/// The words of a shape: a box has its three edges, a sphere its radius, a capsule its radius and
/// the length between its balls, a cylinder its radius and length, a hull no size. Empty for a
/// shape that cannot be shared.
[[nodiscard]] ShapeWords describeShape(const Shape& shape);
[[nodiscard]] std::string toText(const ShapeWords& words);

/// True if `words` have the same kind and, where they have sizes, the same within a thousandth.
[[nodiscard]] bool matches(const ShapeWords& words, const ShapeWords& of_body) noexcept;

/// Equal within a thousandth: a host may have rounded to float, and a user to what is read easily.
[[nodiscard]] bool isNearly(double a, double b) noexcept;

}  // namespace tandem::preload
