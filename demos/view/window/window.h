#pragma once

#include <memory>
#include <string>

#include "tandem/falcon/mouse_device.h"
#include "tandem/plugin/site.h"

namespace tandem::view {

/// A window on a host's own world, whatever is in it, with the user's hand and force.
///
///   tandem::HapticLoop loop(site);
///   tandem::view::Window window(site, world, &mouse);
///   while (window.show()) world.stepSimulation(1.0 / 60.0, 0);
///
/// Start the haptic loop first: the graphics driver's threads then inherit a low priority. The
/// mouse moves the hand and the eye as in `tandem view` (docs/view.md). One at a time, in the main
/// thread, which steps the world as well. Site, world and mouse must outlive it.
class Window {
 public:
  /// `mouse` may be null: then the site has another device, and the mouse moves the eye only.
  /// Throws Error with the remedy if there is no display or no OpenGL 3.3.
  Window(Site& site, btDiscreteDynamicsWorld& world, MouseDevice* mouse = nullptr,
         const std::string& title = "Tandem");
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Takes the user's input and draws the world as it is. Waits so that no more than 60 pictures
  /// are drawn in a second. False once the user has closed the window or pressed Escape.
  [[nodiscard]] bool show();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem::view
