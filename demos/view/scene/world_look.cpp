#include "scene/world_look.h"

#include <array>

#include "tandem/bullet_bridge/convert.h"

namespace tandem::view {
namespace {

constexpr Colour kStaticColour = {0.62F, 0.62F, 0.60F};
constexpr Colour kKinematicColour = {0.47F, 0.54F, 0.62F};
constexpr std::array<Colour, 8> kDynamicColours = {{{0.36F, 0.55F, 0.72F},
                                                    {0.82F, 0.58F, 0.36F},
                                                    {0.45F, 0.65F, 0.48F},
                                                    {0.73F, 0.45F, 0.47F},
                                                    {0.58F, 0.50F, 0.70F},
                                                    {0.76F, 0.69F, 0.42F},
                                                    {0.40F, 0.65F, 0.66F},
                                                    {0.72F, 0.54F, 0.64F}}};

const char* kindOf(const btCollisionObject& object) {
  if (!object.hasContactResponse()) return "ghost ";
  if (object.isStaticObject()) return "static ";
  return object.isKinematicObject() ? "kinematic " : "dynamic ";
}

Colour colourOf(const btCollisionObject& object, std::uint32_t number) {
  if (object.isStaticObject()) return kStaticColour;
  if (object.isKinematicObject()) return kKinematicColour;
  return kDynamicColours[number % kDynamicColours.size()];
}

bool hasFinitePose(const Solid& solid) {
  return solid.p_WB.allFinite() && solid.q_WB.coeffs().allFinite();
}

}  // namespace

DrawList WorldLook::look(btDiscreteDynamicsWorld& world, const WorldDetails& details) {
  ++look_count_;
  DrawList list;
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) addSolid(list, *objects[i]);
  dropUnused();
  list.lines = collectWorldLines(world, details);
  return list;
}

void WorldLook::addSolid(DrawList& list, const btCollisionObject& object) {
  // Each object counts as seen, so that it keeps its number also while nothing of it is drawn.
  auto [name, colour] = lookOf(object);
  Solid solid;
  solid.mesh = meshOf(*object.getCollisionShape());
  solid.colour = colour;
  solid.name = std::move(name);
  solid.is_ghost = !object.hasContactResponse();
  solid.has_grid = object.getCollisionShape()->getShapeType() == STATIC_PLANE_PROXYTYPE;
  solid.p_WB = fromBullet(object.getWorldTransform().getOrigin());
  solid.q_WB = fromBullet(object.getWorldTransform().getRotation());
  if (!solid.mesh->indices.empty() && hasFinitePose(solid)) list.solids.push_back(std::move(solid));
}

BodyLook WorldLook::lookOf(const btCollisionObject& object) {
  const std::uint32_t number = numberOf(object);
  if (const auto given = looks_.find(&object); given != looks_.end()) return given->second;
  return {kindOf(object) + std::to_string(number), colourOf(object, number)};
}

std::uint32_t WorldLook::numberOf(const btCollisionObject& object) {
  const auto [kept, is_new] = numbers_.try_emplace(&object);
  if (is_new) kept->second.number = next_number_++;
  kept->second.last_look = look_count_;
  return kept->second.number;
}

std::shared_ptr<const ShapeMesh> WorldLook::meshOf(const btCollisionShape& shape) {
  KeptMesh& kept = meshes_[computeShapeKey(shape)];
  if (!kept.mesh) kept.mesh = std::make_shared<const ShapeMesh>(makeShapeMesh(shape));
  kept.last_look = look_count_;
  return kept.mesh;
}

void WorldLook::dropUnused() {
  const auto is_unused = [this](const auto& entry) {
    return entry.second.last_look != look_count_;
  };
  std::erase_if(meshes_, is_unused);
  std::erase_if(numbers_, is_unused);
}

}  // namespace tandem::view
