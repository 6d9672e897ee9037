#pragma once

#include <memory>
#include <string>

#include "gl/projection.h"

struct GLFWwindow;

namespace tandem::view {

/// OpenGL 3.3 core without a display, by EGL's surfaceless platform of Mesa. Draw into a
/// FrameTarget. The context is current in the thread that made it, until the end. Mesa's software
/// driver starts its threads here: set LP_NUM_THREADS and the thread's priority before.
class HeadlessContext {
 public:
  /// Throws Error with one line that says what failed and the remedy.
  HeadlessContext();
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

 private:
  struct Egl;
  std::unique_ptr<Egl> egl_;
};

/// A window on the desktop with OpenGL 3.3 core, which is current in the thread that made it: the
/// main thread. One at a time. It never waits for the display: the caller limits its frames.
class GlWindow {
 public:
  /// Throws Error with one line that says what failed and the remedy.
  GlWindow(const std::string& title, PictureSize size);
  ~GlWindow();
  GlWindow(const GlWindow&) = delete;
  GlWindow& operator=(const GlWindow&) = delete;

  /// For events and for Dear ImGui.
  [[nodiscard]] GLFWwindow* handle() const noexcept { return window_; }
  /// Takes the events that came in. False once the user has closed the window or pressed Escape.
  [[nodiscard]] bool isOpen() const;
  /// The size of the content; empty while the window is minimised [pixel].
  [[nodiscard]] PictureSize size() const;
  /// Makes drawing go to the window; off-screen targets take it away.
  void bind() const;
  /// Shows what was drawn.
  void show() const;

 private:
  GLFWwindow* window_ = nullptr;
};

}  // namespace tandem::view
