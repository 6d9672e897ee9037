#include "site/site_impl.h"

// A host destroys its world while a site is attached. Everything is given back in that very call,
// while bodies and broadphase are still there; from then on nothing of the world is touched.

namespace tandem {

void Site::Impl::hostWorldEnds() noexcept {
  status_of_host |= kWorldGone;
  may_skip = quiet = false;
  demoteAll();
  lookForTheLastTime();
  obstacles.forgetWorld();

  // What gives back when it ends. Ticks know nothing of it when it does.
  std::vector<std::unique_ptr<HapticBody>> bodies;
  std::vector<std::unique_ptr<SphereBody>> proxies;
  std::unique_ptr<NativeModel> model;
  bodies.reserve(objects.size());
  proxies.reserve(remotes.size());
  desk.run([&] {
    obstacles.commit();
    island.setObstacles(obstacles.nearSpheres());
    model.swap(native);
    for (Remote& remote : remotes) {
      proxies.push_back(std::move(remote.proxy));
      remote.held_proxy = nullptr;
      remote.body.bullet = nullptr;
    }
    for (SharedObject& object : objects) {
      bodies.push_back(std::move(object.bullet));
      object.body.bullet = nullptr;
    }
  });
  model.reset();
  proxies.clear();
  bodies.clear();
}

/// Bodies as the host had them at last, and what there was to be said about them.
void Site::Impl::lookForTheLastTime() {
  forEachBody([&](SiteBody& body) {
    last_warnings.insert(last_warnings.end(), body.bullet->warnings().begin(),
                         body.bullet->warnings().end());
    if (!desk.isOpen() && body.bullet->isInWorld()) body.seen = body.bullet->state();
  });
}

}  // namespace tandem
