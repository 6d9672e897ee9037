#include <array>
#include <cstdio>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "gl/gl_context.h"

namespace tandem::view {
namespace {

[[noreturn]] void fail(const std::string& what) {
  std::array<char, 32> code = {};
  std::snprintf(code.data(), code.size(), " (EGL error 0x%x)",
                static_cast<unsigned int>(eglGetError()));
  throw Error(what + code.data() + ": install Mesa's libegl1 and libgl1-mesa-dri");
}

EGLDisplay openDisplay() {
  const EGLDisplay display =
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY) fail("no EGL without a display");
  if (eglInitialize(display, nullptr, nullptr) != EGL_TRUE) fail("EGL does not start");
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) fail("EGL has no OpenGL");
  return display;
}

EGLConfig chooseConfig(EGLDisplay display) {
  // No kind of surface is asked for: the pictures are framebuffer objects.
  const std::array<EGLint, 5> wanted = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                        EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE || count < 1)
    fail("EGL has no configuration for OpenGL");
  return config;
}

EGLContext makeContext(EGLDisplay display) {
  const std::array<EGLint, 7> wanted = {EGL_CONTEXT_MAJOR_VERSION,
                                        3,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        3,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                        EGL_NONE};
  const EGLContext context =
      eglCreateContext(display, chooseConfig(display), EGL_NO_CONTEXT, wanted.data());
  if (context == EGL_NO_CONTEXT) fail("EGL gives no OpenGL 3.3 core");
  return context;
}

}  // namespace

struct HeadlessContext::Egl {
  EGLDisplay display = openDisplay();
  EGLContext context = makeContext(display);

  Egl() {
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) return;
    eglDestroyContext(display, context);
    fail("EGL cannot draw without a surface");
  }
  // The display stays open, because other contexts of the process share it.
  ~Egl() {
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
  }
  Egl(const Egl&) = delete;
  Egl& operator=(const Egl&) = delete;
};

HeadlessContext::HeadlessContext() : egl_(std::make_unique<Egl>()) {}
HeadlessContext::~HeadlessContext() = default;

}  // namespace tandem::view
