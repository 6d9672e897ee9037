#pragma once

#include <vector>

#include "geometry/compound_parts.h"
#include "geometry/contact_geometry.h"
#include "geometry/mesh_pieces.h"
#include "island/island_model.h"

namespace tandem {

/// A contact that may push: a sphere body with another body or with an obstacle.
struct Touch {
  BodyIndex sphere = 0;
  BodyIndex other = 0;                 ///< the sphere itself with an obstacle
  const Obstacle* obstacle = nullptr;  ///< null: `other` is a body
  CouplerGains gains;
  const CompoundParts::Part* part = nullptr;  ///< of a compound; null: the whole shape
  int piece = -1;                             ///< triangle of a mesh; -1: the whole mesh
  int touched = -1;        ///< face that the sphere has touched, or triangle: TouchedFaces
  double allowance = 0.0;  ///< overlap that does not push yet [m]: TouchMemory
};

/// The shape of the other body or obstacle, without regard to parts.
[[nodiscard]] inline const Shape& wholeShapeOf(const IslandModel& model,
                                               const Touch& touch) noexcept {
  return touch.obstacle ? touch.obstacle->shape : model.bodies[touch.other].settings.shape;
}

/// The shape that touches the sphere: of a compound one part.
[[nodiscard]] inline const Shape& shapeOf(const IslandModel& model, const Touch& touch) noexcept {
  return touch.part ? touch.part->shape : wholeShapeOf(model, touch);
}

/// TouchKey::obstacle of the obstacle at a place of the list.
[[nodiscard]] inline std::uint64_t keyOf(const Obstacle& obstacle, std::size_t place) noexcept {
  return obstacle.id != 0 ? obstacle.id : place + 1;
}
/// Key of the touch in the model's memory.
[[nodiscard]] TouchKey keyOf(const IslandModel& model, const Touch& touch) noexcept;

/// State of a touch at one instant; for a whole mesh, at its nearest point.
struct TouchState {
  SphereContact geometry;
  double overlap_rate = 0.0;  ///< [m/s]

  [[nodiscard]] double overlap() const { return -geometry.gap; }
};

/// States of all bodies, by index.
using States = std::vector<RigidState>;

/// A body alone is watched when something comes this close [m].
inline constexpr double kWatchDistance = 1e-4;

/// Pose of the shape that touches.
struct ShapePose {
  Vec3 p_W = Vec3::Zero();
  Quat q_W = Quat::Identity();
};
[[nodiscard]] ShapePose poseOf(const Touch& touch, const States& states) noexcept;
/// The same with the body or obstacle elsewhere.
[[nodiscard]] ShapePose poseOf(const Touch& touch, const Vec3& p_WB, const Quat& q_WB) noexcept;

/// False if the bounding spheres are farther apart than `reach` [m], and nothing is remembered. It
/// takes a few additions, and for a part a rotation; exact geometry needs a root, too.
[[nodiscard]] bool couldMeet(const IslandModel& model, const Touch& touch, const States& states,
                             double reach) noexcept;

[[nodiscard]] TouchState computeTouchState(const IslandModel& model, const Touch& touch,
                                           const States& states) noexcept;

/// [K overlap + B overlap_rate]+ of eqs (7), (8), (11), (12) [N].
[[nodiscard]] double computePush(const Touch& touch, const TouchState& state) noexcept;

/// Adds the force of size `push` to both partners.
void addPush(const IslandModel& model, const Touch& touch, const TouchState& state, double push,
             const States& states, std::vector<Wrench>& wrenches) noexcept;

/// Deepest overlap of a body in its smooth contacts except with ghosts [m]; 0 if none.
[[nodiscard]] double computeOverlap(const IslandModel& model, const States& states,
                                    BodyIndex body) noexcept;

/// Adds the face that the model remembers of the touch, if any.
inline void recallFace(const IslandModel& model, Touch& touch) noexcept {
  if (!model.faces.isEmpty()) [[unlikely]]
    touch.touched = model.faces.find(keyOf(model, touch));
}

/// Adds what the model remembers of the contact, if anything: rare. The allowance is that of the
/// middle of the coming advance, or `ahead` of it [s].
[[gnu::cold]] void addMemory(const IslandModel& model, Touch& touch, double ahead) noexcept;
inline void recall(const IslandModel& model, Touch& touch, double ahead = 0.0) noexcept {
  if (!model.memory.isEmpty()) addMemory(model, touch, ahead);
}

/// True for a mesh that forEachPiece() must split first.
[[nodiscard]] inline bool isWholeMesh(const IslandModel& model, const Touch& touch) noexcept {
  return touch.piece < 0 && std::holds_alternative<Mesh>(shapeOf(model, touch));
}

/// True if a piece of a mesh pushes with its face, and not with an edge or corner.
[[nodiscard]] inline bool isOverFace(const IslandModel& model, const Touch& piece,
                                     const States& states) noexcept {
  return computeTouchState(model, piece, states).geometry.under == kMeshFace;
}

/// Calls `visit(touch, gap)` for each piece of a whole mesh that pushes at a gap below `allowance`
/// [m]. Includes pieces that would push after a move of that length.
template <typename Visit>
void forEachPiece(const IslandModel& model, const Touch& whole, const States& states,
                  double allowance, Visit visit) noexcept {
  const Mesh& mesh = *std::get_if<Mesh>(&shapeOf(model, whole));
  const double radius = std::get_if<Sphere>(&model.bodies[whole.sphere].settings.shape)->radius;
  const ShapePose pose = poseOf(whole, states);
  const PlainVec c_B =
      PlainRotation(pose.q_W).toBody(PlainVec(states[whole.sphere].p_W) - PlainVec(pose.p_W));
  forEachPiece(c_B, mesh, whole.touched, radius + allowance, allowance,
               [&](int piece, const Separation& found) {
                 Touch touch = whole;
                 touch.piece = piece;
                 visit(touch, computeGap(found, radius));
               });
}

/// True for a compound, whose parts touch. A guided island knows extents only: there it is one.
[[nodiscard]] inline bool hasParts(const IslandModel& model, const Touch& whole) noexcept {
  return std::holds_alternative<Compound>(wholeShapeOf(model, whole)) && !model.settings.guide;
}

/// Calls `visit` with the touch of each part of a compound, which has the face that the model
/// remembers.
template <typename Visit>
void forEachPart(const IslandModel& model, const Touch& whole, Visit visit) {
  for (const CompoundParts::Part& part :
       std::get_if<Compound>(&wholeShapeOf(model, whole))->parts->all()) {
    Touch touch = whole;
    touch.part = &part;
    recallFace(model, touch);
    visit(touch);
  }
}

/// True if a part of a compound may be nearer than `reach` [m], or is remembered.
[[nodiscard]] inline bool couldMeetAnyPart(const IslandModel& model, const Touch& whole,
                                           const States& states, double reach) noexcept {
  return couldMeet(model, whole, states, reach) || model.faces.holdsPartOf(keyOf(model, whole));
}

/// Lets forEachTouch() visit all parts of all compounds.
inline constexpr auto kAllCompounds = [](const Touch&) { return true; };

/// Calls `visit` with every possible touch of present bodies: pairs of bodies, and spheres with
/// slots and obstacles. Meshes stay whole. `takes(whole)` tells whether a compound's parts matter.
/// With `only` it visits the touches of that body alone.
template <typename Visit, typename Takes = decltype(kAllCompounds)>
void forEachTouch(const IslandModel& model, Visit visit, Takes takes = kAllCompounds,
                  BodyIndex only = kStanding) {
  const auto isMeant = [&](BodyIndex a, BodyIndex b) {
    return only == kStanding || a == only || b == only;
  };
  const auto show = [&](Touch&& touch) {
    if (hasParts(model, touch)) [[unlikely]] {
      if (takes(touch)) forEachPart(model, touch, visit);
      return;
    }
    recallFace(model, touch);
    visit(touch);
  };
  for (const IslandContact& pair : model.present_contacts)
    if (isMeant(pair.sphere, pair.other))
      show({pair.sphere, pair.other, nullptr,
            computeShare(pair.gains, model.contactShare(pair.sphere, pair.other))});
  for (const BodyIndex b : model.present) {
    if (!model.bodies[b].settings.feels_obstacles || !model.bodies[b].isTouchable()) continue;
    const CouplerGains gains =
        computeShare(model.settings.obstacle_contact, model.bodies[b].contact_share);
    for (BodyIndex slot : model.slots)
      if (isMeant(b, slot) && model.bodies[slot].is_active &&
          model.bodies[slot].settings.touches_spheres && model.letsMeet(b, slot))
        show({b, slot, nullptr, gains});
    if (!model.obstacles || !isMeant(b, b)) continue;
    const CollisionFilter& filter = model.bodies[b].settings.filter;
    for (const Obstacle& obstacle : *model.obstacles)
      if (filter.meets(obstacle.filter)) show({b, b, &obstacle, gains});
  }
}

}  // namespace tandem
