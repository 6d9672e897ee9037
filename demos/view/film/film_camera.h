#pragma once

#include <memory>

#include "gl/frame_target.h"
#include "gl/gl_scene.h"
#include "gl/picture.h"
#include "scenario/scenario.h"
#include "scene/draw_list.h"

namespace tandem::view {

/// Takes the pictures of a film as a user sees the world, with both hands. Needs a current context
/// of OpenGL, also when it is deleted.
class FilmCamera {
 public:
  /// At `eye`. Throws Error as FrameTarget and GlScene do.
  FilmCamera(PictureSize size, const demos::Scenario& scenario, const Eye& eye);

  /// Adds the user's own hand `hip_W` [m] and its force [N] to the list, and draws it.
  [[nodiscard]] Picture take(DrawList list, const Vec3& hip_W, const Vec3& force_W);

 private:
  GlScene scene_{Quality::kStill};
  FrameTarget target_;
  std::shared_ptr<const ShapeMesh> ball_;
  Eye eye_;
};

}  // namespace tandem::view
