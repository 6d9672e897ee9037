#include "gl/shadow_map.h"

#include <array>

#include "gl/gl_program.h"

namespace tandem::view {

ShadowMap::ShadowMap(int resolution)
    : resolution_(resolution), depths_(makeTexture()), frame_(makeFramebuffer()) {
  glBindTexture(GL_TEXTURE_2D, depths_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, resolution, resolution, 0,
               GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
  // One look-up compares 2 x 2 depths and blends the answers.
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  // Beyond its edges there is no shadow.
  const std::array<float, 4> farthest = {1.0F, 1.0F, 1.0F, 1.0F};
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, farthest.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);

  glBindFramebuffer(GL_FRAMEBUFFER, frame_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depths_.name(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  const bool is_complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  requireNoGlError("making the shadows' picture");
  if (!is_complete)
    throw Error(
        "the graphics driver cannot draw shadows: update it, or set "
        "LIBGL_ALWAYS_SOFTWARE=1");
}

void ShadowMap::begin() const {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.name());
  glViewport(0, 0, resolution_, resolution_);
  glClear(GL_DEPTH_BUFFER_BIT);
  // Steep surfaces are moved away from the sun, or they would shadow themselves in stripes.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5F, 2.0F);
}

void ShadowMap::end() const {
  glDisable(GL_POLYGON_OFFSET_FILL);
  glActiveTexture(GL_TEXTURE0);
  glBindSampler(0, 0);
  glBindTexture(GL_TEXTURE_2D, depths_.name());
}

}  // namespace tandem::view
