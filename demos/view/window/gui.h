#pragma once

struct GLFWwindow;

namespace tandem::view {

/// Dear ImGui in a window: one frame from begin() to draw(). One at a time, in the thread of the
/// window. Make it after all callbacks of the window are set.
class Gui {
 public:
  explicit Gui(GLFWwindow* window);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  void begin();
  void draw();
  /// True while the pointer is on a panel or drags one of its parts.
  [[nodiscard]] bool hasPointer() const;
};

}  // namespace tandem::view
