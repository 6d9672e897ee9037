#include "session/scene_look.h"

#include <algorithm>

namespace tandem::view {
namespace {

constexpr double kArrowPerNewton = 0.012;  // [m/N]
constexpr float kArrowWidth = 3.0F;        // [pixel]
constexpr const char* kFloor = "floor";
/// A copy that is nearer than this is not seen beside the own one [m].
constexpr double kApart = 1e-3;

constexpr Colour kNeighbourColour{0.55F, 0.65F, 0.75F}, kObstacleColour{0.45F, 0.45F, 0.47F},
    kFloorColour{0.87F, 0.87F, 0.85F};

Colour chooseColour(const demos::SceneBody& body) {
  if (body.role == "object") return kObjectColour;
  if (body.role == "proxy") return kOtherColour;
  if (body.name == kFloor) return kFloorColour;
  return body.is_static ? kObstacleColour : kNeighbourColour;
}

BodyLooks nameBodies(const demos::SiteWorld& world) {
  BodyLooks looks;
  for (const demos::SceneBody& body : world.bodies())
    if (body.body) looks[body.body] = {body.name, chooseColour(body)};
  return looks;
}

template <class Visit>
void visitObjects(const demos::SiteWorld& world, const Visit& visit) {
  for (const demos::SceneBody& body : world.bodies())
    if (body.role == "object") visit(body);
}

}  // namespace

void addArrow(DrawList& list, const Vec3& from_W, const Vec3& way_W, const Colour& colour) {
  const double length = way_W.norm();
  if (!(length > 1e-4)) return;
  const Vec3 tip_W = from_W + way_W;
  const Vec3 side_W = way_W.unitOrthogonal(), other_W = way_W.cross(side_W) / length;
  const double head = std::min(0.3 * length, 0.006);
  const Vec3 base_W = tip_W - head / length * way_W;
  list.lines.push_back({from_W, tip_W, colour, kArrowWidth});
  for (const Vec3& out_W : {Vec3(side_W), Vec3(-side_W), Vec3(other_W), Vec3(-other_W)})
    list.lines.push_back({tip_W, base_W + 0.5 * head * out_W, colour, kArrowWidth});
}

void addHand(DrawList& list, const std::shared_ptr<const ShapeMesh>& ball, const Vec3& p_W,
             const Vec3& f_W, const Colour& colour) {
  Solid solid;
  solid.mesh = ball;
  solid.p_WB = p_W;
  solid.colour = colour;
  solid.name = "hand";
  list.solids.push_back(solid);
  addArrow(list, p_W, kArrowPerNewton * f_W, colour);
}

SceneLook::SceneLook(demos::SiteWorld& own, demos::SiteWorld& other)
    : own_(own), other_(other), world_look_(nameBodies(own)), other_look_(nameBodies(other)) {}

DrawList SceneLook::look(const WorldDetails& details) {
  DrawList list = world_look_.look(own_.world(), details);
  for (Solid& solid : list.solids) solid.has_grid |= solid.name == kFloor;
  const DrawList theirs = other_look_.look(other_.world());
  visitObjects(other_, [&](const demos::SceneBody& body) {
    const auto isOf = [&](const Solid& solid) { return solid.name == body.name; };
    const auto here = std::find_if(list.solids.begin(), list.solids.end(), isOf);
    const auto there = std::find_if(theirs.solids.begin(), theirs.solids.end(), isOf);
    if (here == list.solids.end() || there == theirs.solids.end()) return;
    if ((here->p_WB - there->p_WB).norm() < kApart) return;
    list.solids.push_back(*there);
    list.solids.back().is_ghost = true;
    list.solids.back().colour = kOtherColour;
  });
  return list;
}

double SceneLook::measureApart() const {
  double apart = 0.0;
  visitObjects(own_, [&](const demos::SceneBody& here) {
    visitObjects(other_, [&](const demos::SceneBody& there) {
      if (here.name == there.name)
        apart = std::max(apart, (own_.pose(here).p_W - other_.pose(there).p_W).norm());
    });
  });
  return apart;
}

std::shared_ptr<const ShapeMesh> makeBall(double radius) {
  return std::make_shared<const ShapeMesh>(
      makeShapeMesh(btSphereShape(static_cast<btScalar>(radius))));
}

}  // namespace tandem::view
