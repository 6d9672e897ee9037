#pragma once

#include <utility>

#include "gl/gl_functions.h"

namespace tandem::view {

/// Owns one object of OpenGL. Delete it in the thread and with the context that made it.
template <void (*kDelete)(GLuint)>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(GLuint name) : name_(name) {}
  ~GlObject() { reset(); }
  GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    if (this != &other) {
      reset();
      name_ = std::exchange(other.name_, 0);
    }
    return *this;
  }
  GlObject(const GlObject&) = delete;
  GlObject& operator=(const GlObject&) = delete;

  [[nodiscard]] GLuint name() const noexcept { return name_; }

 private:
  void reset() noexcept {
    if (name_ != 0) kDelete(name_);
  }

  GLuint name_ = 0;
};

namespace gl_detail {
inline void deleteBuffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void deleteVertexArray(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void deleteTexture(GLuint name) { glDeleteTextures(1, &name); }
inline void deleteFramebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void deleteRenderbuffer(GLuint name) { glDeleteRenderbuffers(1, &name); }
inline void deleteShader(GLuint name) { glDeleteShader(name); }
inline void deleteProgram(GLuint name) { glDeleteProgram(name); }

template <class Object>
Object make(void (*generate)(GLsizei, GLuint*)) {
  GLuint name = 0;
  generate(1, &name);
  return Object(name);
}
}  // namespace gl_detail

using GlBuffer = GlObject<gl_detail::deleteBuffer>;
using GlVertexArray = GlObject<gl_detail::deleteVertexArray>;
using GlTexture = GlObject<gl_detail::deleteTexture>;
using GlFramebuffer = GlObject<gl_detail::deleteFramebuffer>;
using GlRenderbuffer = GlObject<gl_detail::deleteRenderbuffer>;
using GlShader = GlObject<gl_detail::deleteShader>;
using GlProgram = GlObject<gl_detail::deleteProgram>;

inline GlBuffer makeBuffer() { return gl_detail::make<GlBuffer>(glGenBuffers); }
inline GlVertexArray makeVertexArray() { return gl_detail::make<GlVertexArray>(glGenVertexArrays); }
inline GlTexture makeTexture() { return gl_detail::make<GlTexture>(glGenTextures); }
inline GlFramebuffer makeFramebuffer() { return gl_detail::make<GlFramebuffer>(glGenFramebuffers); }
inline GlRenderbuffer makeRenderbuffer() {
  return gl_detail::make<GlRenderbuffer>(glGenRenderbuffers);
}

}  // namespace tandem::view
