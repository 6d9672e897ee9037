#include "scenario/body_checks.h"

#include <algorithm>
#include <cctype>
#include <set>

#include <fmt/format.h>

namespace tandem::demos {
namespace {

using Refuse = std::function<void(const std::string&)>;

/// A form needs these. A hull or mesh needs points or a file.
struct ShapeNeeds {
  bool size = false, radius = false, height = false, file = false;
};

bool takesPoints(const ShapeScenario& shape) {
  return shape.kind == "hull" || shape.kind == "mesh";
}

ShapeNeeds needsOf(const ShapeScenario& shape) {
  if (shape.kind == "box") return {.size = true};
  if (shape.kind == "sphere") return {.radius = true};
  if (takesPoints(shape)) return {.file = shape.points.empty()};
  return {.radius = true, .height = true};
}

/// A mesh with points has triangles, whose corners are among them.
void checkTriangles(const ShapeScenario& shape, const std::string& key, const Refuse& refuse) {
  const bool needs = shape.kind == "mesh" && !shape.points.empty();
  if (needs && shape.triangles.empty()) refuse(key + ": a mesh with points needs triangles");
  if (!needs && !shape.triangles.empty())
    refuse(key + ".triangles: only a mesh with points has them");
  for (const std::array<int, 3>& corners : shape.triangles)
    for (const int corner : corners)
      if (corner < 0 || static_cast<std::size_t>(corner) >= shape.points.size())
        refuse(fmt::format("{}.triangles: there is no point {}; they count from 0 to {}", key,
                           corner, shape.points.size() - 1));
}

/// Checks that a form has what it needs, and nothing else.
void checkShape(const ShapeScenario& shape, const std::string& key, const Refuse& refuse) {
  const ShapeNeeds needs = needsOf(shape);
  const auto check = [&](const char* name, bool is_needed, bool is_given) {
    if (is_needed && !is_given) refuse(fmt::format("{}: a {} needs {}", key, shape.kind, name));
    if (is_given && !is_needed) refuse(fmt::format("{}: a {} has no {}", key, shape.kind, name));
  };
  check("size", needs.size, shape.size.has_value());
  check("radius", needs.radius, shape.radius.has_value());
  check("height", needs.height, shape.height.has_value());
  if (takesPoints(shape) && shape.points.empty() && shape.file.empty())
    refuse(fmt::format("{}: a {} needs points or file", key, shape.kind));
  check("file", needs.file, !shape.file.empty());
  check("points", takesPoints(shape) && !shape.points.empty(), !shape.points.empty());
  if (shape.kind == "hull" && !shape.points.empty() && shape.points.size() < 4)
    refuse(key + ".points: a hull needs at least 4 points");
  checkTriangles(shape, key, refuse);
}

void checkParts(const BodyScenario& body, const std::string& key, const Refuse& refuse) {
  const ShapeScenario& own = body.shape;
  if (own.size || own.radius || own.height || !own.points.empty() || !own.file.empty())
    refuse(key + ": give either a shape or parts");
  for (std::size_t i = 0; i < body.parts.size(); ++i) {
    const std::string part = fmt::format("{}.parts.{}", key, i + 1);
    if (body.parts[i].shape.kind == "mesh") refuse(part + ": a mesh is a body of its own");
    checkShape(body.parts[i].shape, part, refuse);
  }
}

void checkName(const std::string& name, const Refuse& refuse) {
  const auto is_allowed = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-';
  };
  if (name.empty() || name.size() > 57 || !std::ranges::all_of(name, is_allowed))
    refuse("body.name = \"" + name + "\": must be 1 to 57 of A-Z a-z 0-9 . _ -");
  for (const char* taken : {"device", "proxy", "floor", "hand"})
    if (name == taken)
      refuse("body.name = \"" + name + "\": Tandem has one itself; choose another");
}

void checkBody(const BodyScenario& body, const Refuse& refuse) {
  checkName(body.name, refuse);
  const std::string key = "body." + body.name;
  if (body.parts.empty())
    checkShape(body.shape, key, refuse);
  else
    checkParts(body, key, refuse);
  if (body.shape.kind == "mesh" && body.mass > 0.0)
    refuse(key + ".mass: a mesh does not move; leave mass out, or use a hull or parts");
  if (body.inertia && body.mass == 0.0) refuse(key + ".inertia: needs mass above 0, in kg");
  if (body.shared && body.mass == 0.0) refuse(key + ".shared = true: needs mass above 0, in kg");
  if (body.tool_of != 0 && !body.shared) refuse(key + ".tool_of: needs shared = true");
}

void checkTool(const Scenario& s, const BodyScenario& body, const Refuse& refuse) {
  if (body.tool_of > static_cast<int>(s.sites.size()))
    refuse(fmt::format("body.{}.tool_of = {}: there are {} sites", body.name, body.tool_of,
                       s.sites.size()));
}

void checkJoint(const Scenario& s, const JointScenario& joint, std::size_t number,
                const Refuse& refuse) {
  const std::string key = fmt::format("joint.{}", number);
  if (joint.bodies.empty()) refuse(key + ": needs bodies = [one or two names]");
  bool moves = false;
  for (const std::string& name : joint.bodies) {
    const auto body = std::ranges::find(s.bodies, name, &BodyScenario::name);
    if (body == s.bodies.end())
      refuse(fmt::format("{}.bodies: there is no body \"{}\"", key, name));
    else
      moves |= body->mass > 0.0;
  }
  if (!moves) refuse(key + ".bodies: one of them must have mass above 0");
  if (joint.bodies.size() == 2 && joint.bodies[0] == joint.bodies[1])
    refuse(key + ".bodies: a body has no joint with itself");
  const bool has_axis = joint.kind == "hinge" || joint.kind == "slider";
  if (!has_axis && (joint.limits || joint.friction > 0.0))
    refuse(fmt::format("{}: a {} has no limits and no friction", key, joint.kind));
  if (joint.kind == "hinge" && joint.limits &&
      std::max(-(*joint.limits)[0], (*joint.limits)[1]) > 3.14)
    refuse(key + ".limits: a hinge has at most 3.14 rad to each side; leave them out");
}

}  // namespace

void checkBodies(const Scenario& s, const Refuse& refuse) {
  if (!s.isWorld()) {
    if (!s.bodies.empty() || !s.joints.empty())
      refuse("[[body]], [[joint]]: need experiment.kind = \"world\"");
    if (!s.world_file.empty()) refuse("world.file: needs experiment.kind = \"world\"");
    return;
  }
  if (!s.world_file.empty()) return;  // its bodies are not known yet
  if (!s.shared.empty()) refuse("world.share: needs world.file; a [[body]] has shared = true");
  if (s.bodies.empty()) refuse("experiment.kind = \"world\": needs a body, [[body]]");
  if (!s.boxes.empty()) refuse("world.boxes: in a world, boxes are [[body]]");
  std::set<std::string> names;
  for (const BodyScenario& body : s.bodies) {
    checkBody(body, refuse);
    checkTool(s, body, refuse);
    if (!names.insert(body.name).second)
      refuse("body.name = \"" + body.name + "\": two bodies have it; name them apart");
  }
  for (std::size_t i = 0; i < s.joints.size(); ++i) checkJoint(s, s.joints[i], i + 1, refuse);
}

}  // namespace tandem::demos
