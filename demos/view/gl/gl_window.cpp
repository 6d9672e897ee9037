#include <GLFW/glfw3.h>

#include "gl/gl_context.h"
#include "gl/gl_functions.h"

namespace tandem::view {
namespace {

// GLFW's words for its last failure, as part of a line.
std::string describeFailure() {
  const char* words = nullptr;
  if (glfwGetError(&words) == GLFW_NO_ERROR || words == nullptr) return {};
  std::string line = words;
  line = line.substr(0, line.find('\n'));
  while (!line.empty() && line.back() == '.') line.pop_back();
  return " (" + line + ")";
}

void setHints() {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_DEPTH_BITS, 24);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  // Smooth edges cost a software driver four times the frame.
  glfwWindowHint(GLFW_SAMPLES, 0);
}

}  // namespace

GlWindow::GlWindow(const std::string& title, PictureSize size) {
  if (size.isEmpty()) throw Error("a window needs a width and a height of at least 1 pixel");
  if (glfwInit() != GLFW_TRUE)
    throw Error("no display" + describeFailure() +
                ": start it in a desktop session; tandem film needs none");
  setHints();
  window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const std::string reason = describeFailure();
    glfwTerminate();
    throw Error("no window with OpenGL 3.3" + reason +
                ": update the graphics driver, or set LIBGL_ALWAYS_SOFTWARE=1");
  }
  glfwMakeContextCurrent(window_);
  // Waiting for the display would slow the desktop on a software driver.
  glfwSwapInterval(0);
}

GlWindow::~GlWindow() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

bool GlWindow::isOpen() const {
  glfwPollEvents();
  return glfwWindowShouldClose(window_) == GLFW_FALSE &&
         glfwGetKey(window_, GLFW_KEY_ESCAPE) != GLFW_PRESS;
}

PictureSize GlWindow::size() const {
  PictureSize size;
  glfwGetFramebufferSize(window_, &size.width, &size.height);
  return size;
}

void GlWindow::bind() const { glBindFramebuffer(GL_FRAMEBUFFER, 0); }

void GlWindow::show() const { glfwSwapBuffers(window_); }

}  // namespace tandem::view
