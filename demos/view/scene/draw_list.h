#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/coordination/types.h"

#include "scene/shape_mesh.h"

namespace tandem::view {

/// Parts of red, green and blue, each from 0 to 1, as a screen shows them (sRGB).
struct Colour {
  float red = 0.0F, green = 0.0F, blue = 0.0F;
};

/// A body's surface at its pose.
struct Solid {
  /// Shared by the list's maker, who keeps it from picture to picture, and by the renderer.
  std::shared_ptr<const ShapeMesh> mesh;
  Vec3 p_WB = Vec3::Zero();  ///< [m]
  Quat q_WB = Quat::Identity();
  Colour colour;
  std::string name;       ///< of the body; for the list as text
  bool is_ghost = false;  ///< drawn as its edges only, so that it hides nothing
  /// A faint net of 0.1 m on its level faces: for floors. Casts no shadow.
  bool has_grid = false;
};

/// A straight line in W.
struct Line {
  Vec3 from_W = Vec3::Zero(), to_W = Vec3::Zero();  ///< [m]
  Colour colour;
  float width = 1.0F;  ///< on the screen [pixel]
};

/// All that a picture shows, independent of how it is drawn.
struct DrawList {
  std::vector<Solid> solids;
  std::vector<Line> lines;
};

/// From where a picture is seen: an eye that circles a target, W's z axis up.
struct Eye {
  Vec3 target_W = Vec3::Zero();  ///< [m]
  double distance = 0.5;         ///< from the target [m]
  double azimuth = -1.2;         ///< about z, from x; of the eye as seen from the target [rad]
  double elevation = 0.5;        ///< above the level through the target [rad]
  double field_of_view = 0.7;    ///< of the picture's height [rad]
};

}  // namespace tandem::view
