#include "session/scene_look.h"

#include <algorithm>
#include <array>
#include <utility>

namespace tandem::view {
namespace {

constexpr double kArrowPerNewton = 0.012;  // [m/N]
constexpr float kArrowWidth = 3.0F;        // [pixel]
constexpr const char* kFloor = "floor";
/// A copy that is nearer than this is not seen beside the own one [m].
constexpr double kApart = 1e-3;

constexpr Colour kNeighbourColour{0.55F, 0.65F, 0.75F}, kObstacleColour{0.45F, 0.45F, 0.47F},
    kFloorColour{0.87F, 0.87F, 0.85F};

/// Of "#rrggbb".
Colour parseColour(const std::string& text) {
  const unsigned long bits = std::stoul(text.substr(1), nullptr, 16);
  const auto channel = [&](int shift) {
    return static_cast<float>((bits >> shift) & 0xFFu) / 255.0F;
  };
  return {channel(16), channel(8), channel(0)};
}

Colour chooseColour(const demos::SceneBody& body) {
  if (!body.colour.empty()) return parseColour(body.colour);
  if (body.role == "object") return kObjectColour;
  if (body.role == "proxy") return kOtherColour;
  if (body.name == kFloor) return kFloorColour;
  return body.is_static ? kObstacleColour : kNeighbourColour;
}

BodyLooks nameBodies(const std::vector<demos::SceneBody>& bodies) {
  BodyLooks looks;
  for (const demos::SceneBody& body : bodies)
    if (body.body) looks[body.body] = {body.name, chooseColour(body)};
  return looks;
}

/// Adds an arrow along a line, seen from all sides.
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

}  // namespace

Colour chooseUserColour(int user) {
  constexpr std::array<Colour, 6> kColours = {{kOwnColour,
                                               kOtherColour,
                                               {0.0F, 0.62F, 0.45F},
                                               {0.80F, 0.47F, 0.65F},
                                               {0.34F, 0.71F, 0.91F},
                                               {0.25F, 0.25F, 0.27F}}};
  return kColours[static_cast<std::size_t>(user) % kColours.size()];
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

double addGhost(DrawList& list, const std::string& name, const RigidState& there,
                const Colour& colour) {
  const auto here = std::find_if(list.solids.begin(), list.solids.end(),
                                 [&](const Solid& solid) { return solid.name == name; });
  if (here == list.solids.end()) return 0.0;
  const double apart = (here->p_WB - there.p_W).norm();
  if (apart < kApart) return apart;
  Solid ghost = *here;
  ghost.p_WB = there.p_W;
  ghost.q_WB = there.q_WB;
  ghost.is_ghost = true;
  ghost.colour = colour;
  list.solids.push_back(std::move(ghost));
  return apart;
}

double addGhosts(DrawList& list, const demos::SiteWorld& other) {
  double apart = 0.0;
  for (const demos::SceneBody& body : other.bodies())
    if (body.role == "object") apart = std::max(apart, addGhost(list, body.name, other.pose(body)));
  return apart;
}

SceneLook::SceneLook(demos::SiteWorld& world) : SceneLook(world.world(), world.bodies()) {}

SceneLook::SceneLook(btDiscreteDynamicsWorld& world, const std::vector<demos::SceneBody>& bodies)
    : world_(world), world_look_(nameBodies(bodies)) {
  for (const demos::SceneBody& body : bodies) names_.insert(body.name);
}

DrawList SceneLook::look(const WorldDetails& details) {
  DrawList list = world_look_.look(world_, details);
  // A body without a name is the hand in Bullet's own contact. Hands are drawn on their own.
  std::erase_if(list.solids, [&](const Solid& solid) { return !names_.contains(solid.name); });
  for (Solid& solid : list.solids) solid.has_grid |= solid.name == kFloor;
  return list;
}

std::shared_ptr<const ShapeMesh> makeBall(double radius) {
  return std::make_shared<const ShapeMesh>(
      makeShapeMesh(btSphereShape(static_cast<btScalar>(radius))));
}

}  // namespace tandem::view
