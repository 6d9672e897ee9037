#pragma once

#include "scene/world_look.h"
#include "world/scene.h"

namespace tandem::view {

/// Colours of users and objects, equal in all pictures (Okabe and Ito: also for the colour-blind).
inline constexpr Colour kOwnColour{0.0F, 0.45F, 0.70F}, kOtherColour{0.84F, 0.37F, 0.0F},
    kObjectColour{0.90F, 0.62F, 0.0F};

/// Adds a hand: a ball, and its force on the user as an arrow of 12 mm for each newton.
void addHand(DrawList& list, const std::shared_ptr<const ShapeMesh>& ball, const Vec3& p_W,
             const Vec3& f_W, const Colour& colour);

/// Adds an arrow along a line, seen from all sides.
void addArrow(DrawList& list, const Vec3& from_W, const Vec3& way_W, const Colour& colour);

/// Makes pictures of one site's world: its bodies, and the other site's copies as ghosts where they
/// are elsewhere. For the thread that steps both worlds, between their steps.
class SceneLook {
 public:
  SceneLook(demos::SiteWorld& own, demos::SiteWorld& other);

  [[nodiscard]] DrawList look(const WorldDetails& details = {});
  /// Largest distance of two copies of an object [m]; 0 without objects.
  [[nodiscard]] double measureApart() const;

 private:
  demos::SiteWorld& own_;
  demos::SiteWorld& other_;
  WorldLook world_look_, other_look_;
};

/// The ball of a hand.
[[nodiscard]] std::shared_ptr<const ShapeMesh> makeBall(double radius);

}  // namespace tandem::view
