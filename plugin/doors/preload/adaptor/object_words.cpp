#include "object_words.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

namespace tandem::preload {
namespace {

const std::map<std::string, std::size_t>& sizesOfKinds() {
  static const std::map<std::string, std::size_t> sizes{
      {"box", 3},  {"sphere", 1}, {"capsule", 2}, {"cylinder", 2},
      {"cone", 2}, {"hull", 0},   {"compound", 0}};
  return sizes;
}

}  // namespace

std::optional<ShapeWords> parseShapeWords(const std::string& text) {
  std::istringstream stream(text);
  ShapeWords words;
  stream >> words.kind;
  const auto kind = sizesOfKinds().find(words.kind);
  if (kind == sizesOfKinds().end()) return std::nullopt;
  for (double size = 0.0; stream >> size;) {
    if (!(size > 0.0) || !std::isfinite(size)) return std::nullopt;
    words.sizes.push_back(size);
  }
  if (!stream.eof() || (!words.sizes.empty() && words.sizes.size() != kind->second))
    return std::nullopt;
  return words;
}

ShapeWords describeShape(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    const Vec3 edges = 2.0 * box->half_extents;
    return {"box", {edges.x(), edges.y(), edges.z()}};
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return {"sphere", {sphere->radius}};
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return {"capsule", {capsule->radius, 2.0 * capsule->half_length}};
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    return {"cylinder", {cylinder->radius, 2.0 * cylinder->half_length}};
  if (const auto* cone = std::get_if<Cone>(&shape))
    return {"cone", {cone->radius, 2.0 * cone->half_length}};
  if (std::holds_alternative<ConvexHull>(shape)) return {"hull", {}};
  if (std::holds_alternative<Compound>(shape)) return {"compound", {}};
  return {};
}

std::string toText(const ShapeWords& words) {
  std::string text = words.kind;
  for (const double size : words.sizes) {
    char number[32];
    std::snprintf(number, sizeof number, " %.5g", size);
    text += number;
  }
  return text;
}

bool isNearly(double a, double b) noexcept { return std::abs(a - b) <= 1e-3 * std::abs(b); }

bool matches(const ShapeWords& words, const ShapeWords& of_body) noexcept {
  if (words.kind != of_body.kind) return false;
  if (words.sizes.empty()) return true;
  for (std::size_t i = 0; i < words.sizes.size(); ++i)
    if (!isNearly(words.sizes[i], of_body.sizes[i])) return false;
  return true;
}

}  // namespace tandem::preload
