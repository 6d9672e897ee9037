#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "scene/world_look.h"
#include "world/scene.h"

namespace tandem::view {

/// Colours of users and objects, equal in all pictures (Okabe and Ito: also for the colour-blind).
inline constexpr Colour kOwnColour{0.0F, 0.45F, 0.70F}, kOtherColour{0.84F, 0.37F, 0.0F},
    kObjectColour{0.90F, 0.62F, 0.0F};

/// The colour of a user, from 0, in a picture that belongs to none of them. Six colours take turns.
[[nodiscard]] Colour chooseUserColour(int user);

/// The ball of a hand.
[[nodiscard]] std::shared_ptr<const ShapeMesh> makeBall(double radius);

/// Adds a hand: a ball, and its force on the user as an arrow of 12 mm for each newton.
void addHand(DrawList& list, const std::shared_ptr<const ShapeMesh>& ball, const Vec3& p_W,
             const Vec3& f_W, const Colour& colour);

/// Adds the edges of a body where the other site has its copy, if that is elsewhere. Returns how
/// far the two are apart [m].
double addGhost(DrawList& list, const std::string& name, const RigidState& there,
                const Colour& colour = kOtherColour);

/// The same for all objects of the other site's world, if that is at hand. Returns the largest
/// distance [m]; 0 without objects.
double addGhosts(DrawList& list, const demos::SiteWorld& other);

/// Makes pictures of one site's world. For the thread that steps it, between steps.
class SceneLook {
 public:
  explicit SceneLook(demos::SiteWorld& world);
  /// The same of a world without a site, which has these bodies.
  SceneLook(btDiscreteDynamicsWorld& world, const std::vector<demos::SceneBody>& bodies);

  [[nodiscard]] DrawList look(const WorldDetails& details = {});

 private:
  btDiscreteDynamicsWorld& world_;
  std::set<std::string> names_;
  WorldLook world_look_;
};

}  // namespace tandem::view
