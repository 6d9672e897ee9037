#include "window/window.h"

#include "gl/gl_context.h"
#include "gl/gl_scene.h"
#include "window/frame_pace.h"
#include "window/hand_input.h"
#include "window/hand_look.h"

namespace tandem::view {
namespace {

constexpr double kHandRadius = 0.01;  // without a setting that tells it [m]
constexpr PictureSize kSize{1280, 800};

}  // namespace

struct Window::Impl {
  Site& site;
  btDiscreteDynamicsWorld& world;
  MouseDevice* mouse;
  GlWindow window;
  GlScene scene;
  HandInput input{window.handle()};
  WorldLook world_look;
  HandLook hand_look{kHandRadius};
  Eye eye;
  FramePace pace;

  Impl(Site& the_site, btDiscreteDynamicsWorld& the_world, MouseDevice* the_mouse,
       const std::string& title)
      : site(the_site), world(the_world), mouse(the_mouse), window(title, kSize) {}

  [[nodiscard]] DrawList look() {
    DrawList list = world_look.look(world);
    Vec3 hip_W, force_W;
    site.betweenTicks([&] {
      hip_W = site.hip().p_W;
      force_W = site.force();
    });
    hand_look.add(list, mouse, hip_W, force_W);
    return list;
  }
  void draw(double time) {
    const PictureSize size = window.size();
    if (size.isEmpty()) return;
    input.apply(mouse, eye, size, time, true);
    window.bind();
    scene.draw(look(), eye, size);
    window.show();
  }
};

Window::Window(Site& site, btDiscreteDynamicsWorld& world, MouseDevice* mouse,
               const std::string& title)
    : impl_(std::make_unique<Impl>(site, world, mouse, title)) {}

Window::~Window() = default;

bool Window::show() {
  const double now = impl_->pace.wait();
  const bool is_open = impl_->window.isOpen();
  impl_->draw(now);
  return is_open;
}

}  // namespace tandem::view
