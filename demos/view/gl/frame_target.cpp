#include "gl/frame_target.h"

#include <string>

namespace tandem::view {
namespace {

GlRenderbuffer makeStore(GLenum format, PictureSize size, int samples) {
  GlRenderbuffer store = makeRenderbuffer();
  glBindRenderbuffer(GL_RENDERBUFFER, store.name());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, format, size.width,
                                   size.height);
  return store;
}

void attach(GLenum place, const GlRenderbuffer& store) {
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, store.name());
}

void requireComplete(PictureSize size) {
  // A store that is too large leaves an error, which nobody else should find.
  const bool has_failed = glGetError() != GL_NO_ERROR;
  if (!has_failed && glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return;
  throw Error("the graphics driver cannot draw into a picture of " + std::to_string(size.width) +
              " x " + std::to_string(size.height) + " pixels; choose a smaller one");
}

}  // namespace

FrameTarget::FrameTarget(PictureSize size, int samples) : size_(size) {
  if (size.isEmpty()) throw Error("a picture needs a width and a height of at least 1 pixel");
  colour_ = makeStore(GL_RGBA8, size, samples);
  depth_ = makeStore(GL_DEPTH_COMPONENT24, size, samples);
  frame_ = makeFramebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.name());
  attach(GL_COLOR_ATTACHMENT0, colour_);
  attach(GL_DEPTH_ATTACHMENT, depth_);
  requireComplete(size);
  if (samples <= 1) return;
  plain_colour_ = makeStore(GL_RGBA8, size, 1);
  plain_frame_ = makeFramebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, plain_frame_.name());
  attach(GL_COLOR_ATTACHMENT0, plain_colour_);
  requireComplete(size);
  bind();
}

void FrameTarget::bind() const { glBindFramebuffer(GL_FRAMEBUFFER, frame_.name()); }

void FrameTarget::bindForReading() const {
  if (plain_frame_.name() == 0) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_.name());
    return;
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, plain_frame_.name());
  glBlitFramebuffer(0, 0, size_.width, size_.height, 0, 0, size_.width, size_.height,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame_.name());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, plain_frame_.name());
}

}  // namespace tandem::view
