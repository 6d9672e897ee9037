#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tandem/coordination/shape.h"

namespace tandem::preload {

/// A shape as written in a config: "box 0.1 0.1 0.2", "sphere 0.05", or just "box".
struct ShapeWords {
  std::string kind;           ///< box, sphere, capsule, cylinder, cone, hull, compound
  std::vector<double> sizes;  ///< [m]; empty: any size
};

/// Parses a text. Returns nothing if it names no shape or has a wrong number of sizes.
[[nodiscard]] std::optional<ShapeWords> parseShapeWords(const std::string& text);

/// Describes a shape by its sizes. A box has three edges, a sphere its radius. A capsule has its
/// radius and the distance of its spheres' centres, a cylinder or cone its radius and length. A
/// hull or compound has no size. Returns empty words for a shape that cannot be shared.
[[nodiscard]] ShapeWords describeShape(const Shape& shape);
[[nodiscard]] std::string toText(const ShapeWords& words);

/// True if the kinds are equal and the sizes, if given, agree within a thousandth.
[[nodiscard]] bool matches(const ShapeWords& words, const ShapeWords& of_body) noexcept;

/// True within a thousandth: a host may round to float, and a user to few digits.
[[nodiscard]] bool isNearly(double a, double b) noexcept;

}  // namespace tandem::preload
