#include "gl/gl_scene.h"

#include <cstddef>
#include <string>

#include "gl/eye_motion.h"
#include "gl/gl_attribute.h"
#include "gl/gl_program.h"
#include "gl/shaders.h"

// One frame:
//
//   bodies  -> batches by mesh, one buffer of instances
//   batches -> shadow map (without floors)
//           -> picture: bodies, then floors, which they hide in part, then what is left of the sky
//   lines of the list and of ghosts -> picture
namespace tandem::view {
namespace {

// Colours of the sky as the screen shows them.
const Vec3 kTop(0.90, 0.925, 0.95), kBottom(0.80, 0.825, 0.85);

// How far outside of a surface its shadow is looked up [pixels of the shadow map].
constexpr double kShadowOffset = 1.5;

void setState() {
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  glClearDepth(1.0);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
}

void readInstances(GLuint place, int count, std::size_t offset) {
  readAttribute(place, count, sizeof(SolidInstance), offset, 1);
}

// Takes clip space to a texture's: from 0 to 1 in each direction.
Mat4 clipToTexture() {
  Mat4 m = Mat4::Identity();
  m.diagonal().head<3>().setConstant(0.5);
  m.col(3).head<3>().setConstant(0.5);
  return m;
}

const char* shadowDefine(Quality quality) {
  switch (quality) {
    case Quality::kFast:
      return "";
    case Quality::kLive:
      return "#define SHADOWS\n";
    case Quality::kStill:
      return "#define SOFT_SHADOWS\n";
  }
  return "";
}

std::string ofABody(const char* vertex_source) {
  return std::string(shaders::kPlaceOfABody) + vertex_source;
}

GlProgram makeSolidProgram(Quality quality, const char* more) {
  return makeProgram(ofABody(shaders::kSolidVertex), shaders::kSolidFragment,
                     std::string(shadowDefine(quality)) + more);
}

}  // namespace

GlScene::GlScene(Quality quality)
    : quality_(quality),
      shadow_map_(quality == Quality::kStill ? 2048 : 1024),
      solid_(makeSolidProgram(quality, "")),
      grid_(makeSolidProgram(quality, "#define GRID\n")),
      shadow_(makeProgram(ofABody(shaders::kShadowVertex), shaders::kShadowFragment)),
      background_(makeProgram(shaders::kBackgroundVertex, shaders::kBackgroundFragment)),
      instances_(makeBuffer()),
      no_attributes_(makeVertexArray()) {
  requireNoGlError("preparing to draw");
}

void GlScene::draw(const DrawList& list, const Eye& eye, PictureSize size) {
  if (size.isEmpty()) return;
  const Eye limited = limitEye(eye);
  meshes_.beginFrame();
  SolidBatches grouped = groupSolids(list, limited, meshes_);
  if (quality_ == Quality::kFast) grouped.casters.clear();
  uploadInstances(grouped);
  setState();

  GLint target = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
  const ShadowFrame frame = computeShadowFrame(grouped.casters, limited, shadow_map_.resolution());
  drawShadows(grouped, frame);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target));

  glViewport(0, 0, size.width, size.height);
  glClear(GL_DEPTH_BUFFER_BIT);
  drawSolids(grouped, frame, limited, size);
  drawBackground();
  lines_.draw(grouped.ghost_lines, limited, size);
  lines_.draw(list.lines, limited, size);
  requireNoGlError("drawing a picture");
}

void GlScene::uploadInstances(const SolidBatches& grouped) {
  std::vector<SolidInstance> all;
  for (const SolidBatch& batch : grouped.batches)
    all.insert(all.end(), batch.instances.begin(), batch.instances.end());
  glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(all.size() * sizeof(SolidInstance)),
               all.data(), GL_STREAM_DRAW);
}

void GlScene::drawBatches(const SolidBatches& grouped, bool has_grid) const {
  glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
  std::size_t first = 0;
  for (const SolidBatch& batch : grouped.batches) {
    const std::size_t offset = first * sizeof(SolidInstance);
    first += batch.instances.size();
    if (batch.has_grid != has_grid) continue;
    glBindVertexArray(batch.mesh->array.name());
    readInstances(shaders::kOrigin, 3, offset + offsetof(SolidInstance, origin));
    readInstances(shaders::kTurn, 4, offset + offsetof(SolidInstance, turn));
    readInstances(shaders::kColour, 3, offset + offsetof(SolidInstance, colour));
    glDrawElementsInstanced(GL_TRIANGLES, batch.mesh->index_count, GL_UNSIGNED_INT, nullptr,
                            static_cast<GLsizei>(batch.instances.size()));
  }
  glBindVertexArray(0);
}

void GlScene::drawShadows(const SolidBatches& grouped, const ShadowFrame& frame) const {
  shadow_map_.begin();
  if (!grouped.casters.empty()) {
    glUseProgram(shadow_.name());
    setUniform(shadow_, "world_to_clip", frame.world_to_clip);
    drawBatches(grouped, false);
  }
  shadow_map_.end();
}

void GlScene::drawSolids(const SolidBatches& grouped, const ShadowFrame& frame, const Eye& eye,
                         PictureSize size) const {
  const Mat4 world_to_clip = computeWorldToClip(eye, size);
  const Mat4 world_to_shadow = clipToTexture() * frame.world_to_clip;
  for (const bool has_grid : {false, true}) {
    const GlProgram& program = has_grid ? grid_ : solid_;
    glUseProgram(program.name());
    setUniform(program, "world_to_clip", world_to_clip);
    setUniform(program, "world_to_shadow", world_to_shadow);
    setUniform(program, "shadow_offset", kShadowOffset * frame.texel);
    setUniform(program, "eye_W", computeEyePosition(eye));
    setUniform(program, "sun_W", sunDirection());
    setUniform(program, "shadow", 0);
    drawBatches(grouped, has_grid);
  }
}

void GlScene::drawBackground() const {
  glUseProgram(background_.name());
  setUniform(background_, "top", kTop);
  setUniform(background_, "bottom", kBottom);
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
}

}  // namespace tandem::view
