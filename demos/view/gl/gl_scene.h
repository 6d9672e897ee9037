#pragma once

#include <cstddef>

#include "gl/gl_object.h"
#include "gl/line_painter.h"
#include "gl/mesh_store.h"
#include "gl/shadow_map.h"
#include "gl/solid_batches.h"

namespace tandem::view {

/// The cost of a picture.
enum class Quality {
  kFast,   ///< no shadows
  kLive,   ///< shadows with edges of one pixel of their map
  kStill,  ///< shadows with soft edges, for pictures and films that nobody waits for
};

/// Draws pictures of a DrawList: bodies lit by a sun that casts shadows, ghosts as edges, lines,
/// and a light background. The same list gives the same bits from run to run on one driver. Needs a
/// current context of OpenGL 3.3, also when it is deleted.
class GlScene {
 public:
  /// Throws Error if the driver cannot compile the shaders or make the shadows' picture.
  explicit GlScene(Quality quality = Quality::kLive);

  /// Draws all of the lower left `size` pixels of the bound framebuffer, which stays bound. An eye
  /// beyond its limits is drawn from the nearest within (limitEye). State of OpenGL that it changes
  /// stays changed; Dear ImGui sets its own. Allocates.
  void draw(const DrawList& list, const Eye& eye, PictureSize size);

  /// Meshes on the graphics card.
  [[nodiscard]] std::size_t storedMeshes() const noexcept { return meshes_.size(); }

 private:
  void uploadInstances(const SolidBatches& grouped);
  void drawBatches(const SolidBatches& grouped, bool has_grid) const;
  void drawShadows(const SolidBatches& grouped, const ShadowFrame& frame) const;
  void drawSolids(const SolidBatches& grouped, const ShadowFrame& frame, const Eye& eye,
                  PictureSize size) const;
  void drawBackground() const;

  Quality quality_;
  MeshStore meshes_;
  ShadowMap shadow_map_;
  LinePainter lines_;
  GlProgram solid_, grid_, shadow_, background_;
  GlBuffer instances_;
  GlVertexArray no_attributes_;
};

}  // namespace tandem::view
