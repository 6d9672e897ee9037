#include "scenario/body_keys.h"

#include <cctype>

#include "scenario/key_rows.h"
#include "scenario/table_keys.h"

namespace tandem::demos {
namespace {

constexpr std::size_t kMostParts = 50;

std::string readColour(const Place& place, const toml::node& node) {
  const std::string text = readString(place, node);
  const bool is_colour =
      text.size() == 7 && text[0] == '#' && std::all_of(text.begin() + 1, text.end(), [](char c) {
        return std::isxdigit(static_cast<unsigned char>(c)) != 0;
      });
  if (!is_colour) refuse(place, node, "a colour such as \"#E69F00\"");
  return text;
}

int readUser(const Place& place, const toml::node& node) {
  const auto value = node.is_integer() ? node.value<int>() : std::nullopt;
  if (!value || *value < 0 || *value > static_cast<int>(kMostSites))
    refuse(place, node, "the number of a site, 1 to 16; 0: nobody's tool");
  return *value;
}

Vec3 readSize(const Place& place, const toml::node& node) {
  const Vec3 size = readVector(place, node);
  if (!(size.minCoeff() > 0.0)) refuse(place, node, "three lengths above 0");
  return size;
}

Vec3 readInertia(const Place& place, const toml::node& node) {
  const Vec3 inertia = readVector(place, node);
  if (!(inertia.minCoeff() > 0.0)) refuse(place, node, "three moments of inertia above 0");
  return inertia;
}

/// Corners of triangles; which points there are is checked with all else.
std::vector<std::array<int, 3>> readTriangles(const Place& place, const toml::node& node) {
  const FieldRange range{0.0, 1e6, false, "a list of triangles [a, b, c], numbers of points"};
  std::vector<std::array<int, 3>> triangles;
  for (const std::array<double, 3>& row : readRows<3>(place, node, range)) {
    std::array<int, 3>& corners = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = static_cast<int>(row[i]);
      if (corners[i] != row[i]) refuse(place, node, range.allowed);
    }
  }
  return triangles;
}

/// Keys of a form; `shape` finds it in its owner.
template <typename Owner, typename Shape>
std::vector<KeyOf<Owner>> makeShapeKeys(Shape shape) {
  const auto in = [shape](auto member) {
    return [ shape, member ](auto& owner) -> auto& { return std::invoke(shape, owner).*member; };
  };
  const auto length = [](const Place& place, const toml::node& node) {
    return std::optional<double>(readNumber(place, node, kPositive));
  };
  const auto points = [](const Place& place, const toml::node& node) {
    return readRows<3>(place, node, {-1e6, 1e6, false, "a list of points [x, y, z]"});
  };
  using S = ShapeScenario;
  return {
      choiceKey<Owner>({"shape", "form, about its own origin; round ones stand along z"},
                       {"box", "sphere", "capsule", "cylinder", "cone", "hull", "mesh"},
                       in(&S::kind)),
      valueKey<Owner>(
          {"size", "edges of a box", "m", "", "none"}, "three lengths > 0",
          [](const Place& place, const toml::node& node) {
            return std::optional<Vec3>(readSize(place, node));
          },
          in(&S::size)),
      valueKey<Owner>({"radius", "of what is round", "m", "", "none"}, "> 0", length,
                      in(&S::radius)),
      valueKey<Owner>(
          {"height", "of a capsule (between its half balls), cylinder or cone", "m", "", "none"},
          "> 0", length, in(&S::height)),
      valueKey<Owner>(
          {"points", "of a hull, or corners of a mesh: list of `[x, y, z]`", "m", "", "none"},
          "of a hull 4 or more, not in a plane", points, in(&S::points)),
      valueKey<Owner>({"triangles", "of a mesh with points: list of `[a, b, c]`", "", "", "none"},
                      "numbers of points, from 0", &readTriangles, in(&S::triangles)),
      textKey<Owner>(
          {"file", "of a hull or mesh: an OBJ file [m]; path from the scenario", "", "", "none"},
          in(&S::file)),
  };
}

template <typename Owner>
void add(std::vector<KeyOf<Owner>>& keys, const std::vector<KeyOf<Owner>>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
}

std::vector<KeyOf<PartScenario>> makePartKeys() {
  using P = PartScenario;
  auto keys = makeShapeKeys<P>([](auto& part) -> auto& { return part.shape; });
  add(keys, {vectorKey<P>({"position", "in the body", "m"}, &P::position),
             vectorKey<P>({"rotation", "in the body: axis times angle", "rad"}, &P::rotation)});
  return keys;
}

std::vector<KeyOf<BodyScenario>> makeBodyKeys() {
  using B = BodyScenario;
  const auto friction = [](const Place& place, const toml::node& node) {
    return std::optional<double>(readNumber(place, node, kNotNegative));
  };
  std::vector<KeyOf<B>> keys = {
      textKey<B>({"name", "of the body, at both sites", "",
                  "1 to 57 of `A-Z a-z 0-9 . _ -`, no other body's", "must be given"},
                 &B::name)};
  add(keys, makeShapeKeys<B>([](auto& body) -> auto& { return body.shape; }));
  add(keys,
      {tablesKey<B>({"parts",
                     "forms that make one body, in place of `shape`: list of tables with "
                     "the keys of a form, `position` and `rotation`",
                     "", "", "none"},
                    partKeys(), kMostParts, &B::parts),
       numberKey<B>({"mass", "0: static", "kg", "a mesh: 0"}, kNotNegative, &B::mass),
       valueKey<B>(
           {"inertia", "about its own axes", "kg m^2", "mass above 0", "of its shape"},
           "three numbers > 0",
           [](const Place& place, const toml::node& node) {
             return std::optional<Vec3>(readInertia(place, node));
           },
           &B::inertia),
       vectorKey<B>({"position", "of its centre of mass", "m"}, &B::position),
       vectorKey<B>({"rotation", "axis times angle", "rad"}, &B::rotation),
       valueKey<B>({"friction", "of a pair, the product", "", "", "`world.friction`"}, ">= 0",
                   friction, &B::friction),
       numberKey<B>({"restitution", "of a pair, the product"}, kProbability, &B::restitution),
       numberKey<B>({"damping", "of a shared body's copies", "N s/m"}, kNotNegative, &B::damping),
       flagKey<B>({"shared", "both users move it; others are each site's own"}, &B::shared),
       valueKey<B>({"tool_of", "user whose hand holds it always, by its origin", "", "shared only"},
                   "0 (nobody) to the number of sites", &readUser, &B::tool_of),
       valueKey<B>({"colour", "in pictures", "", "", "of its role"}, "`#rrggbb`", &readColour,
                   &B::colour)});
  return keys;
}

std::vector<std::string> readNames(const Place& place, const toml::node& node) {
  const char* allowed = "a list of one or two names of bodies";
  const toml::array* array = node.as_array();
  if (!array || array->empty() || array->size() > 2) refuse(place, node, allowed);
  std::vector<std::string> names;
  for (const toml::node& name : *array) names.push_back(readString(place, name));
  return names;
}

std::optional<std::array<double, 2>> readLimits(const Place& place, const toml::node& node) {
  const char* allowed = "[least, most]";
  const toml::array* array = node.as_array();
  if (!array || array->size() != 2) refuse(place, node, allowed);
  const FieldRange range{-1e6, 1e6, false, allowed};
  const std::array<double, 2> limits = {readNumber(place, (*array)[0], range),
                                        readNumber(place, (*array)[1], range)};
  if (!(limits[0] < limits[1])) refuse(place, node, "[least, most], the first below the second");
  return limits;
}

Vec3 readDirection(const Place& place, const toml::node& node) {
  const Vec3 axis = readVector(place, node);
  if (!(axis.norm() > 1e-3)) refuse(place, node, "a direction, not [0, 0, 0]");
  return axis.normalized();
}

std::vector<KeyOf<JointScenario>> makeJointKeys() {
  using J = JointScenario;
  return {
      choiceKey<J>({"kind",
                    "a hinge turns about the axis, a slider moves along it, a ball turns, "
                    "a weld does not move"},
                   {"hinge", "slider", "ball", "weld"}, &J::kind),
      valueKey<J>({"bodies", "one that the world holds, or two", "", "", "must be given"},
                  "names of bodies, one that moves at least", &readNames, &J::bodies),
      vectorKey<J>({"at", "a point of the axis", "m"}, &J::at),
      valueKey<J>({"axis", "of a hinge or slider; is normalised"}, "not zero", &readDirection,
                  &J::axis),
      valueKey<J>(
          {"limits", "of a hinge or slider: `[least, most]`, from the start", "rad, m", "", "none"},
          "least < most", &readLimits, &J::limits),
      numberKey<J>({"friction", "of a hinge or slider, the most", "N m, N"}, kNotNegative,
                   &J::friction),
  };
}

}  // namespace

const std::vector<KeyOf<PartScenario>>& partKeys() {
  static const auto keys = makePartKeys();
  return keys;
}

const std::vector<KeyOf<BodyScenario>>& bodyKeys() {
  static const auto keys = makeBodyKeys();
  return keys;
}

const std::vector<KeyOf<JointScenario>>& jointKeys() {
  static const auto keys = makeJointKeys();
  return keys;
}

}  // namespace tandem::demos
