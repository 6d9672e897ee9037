#include "tandem/plugin/site.h"

#include <algorithm>

#include "site/site_impl.h"

namespace tandem {

Site::Site(const SiteSettings& settings, btDiscreteDynamicsWorld& world, HapticDevice& device,
           BulletAbi host)
    : impl_(std::make_unique<Impl>(settings, world, device, host)) {}
Site::~Site() = default;

ObjectId Site::share(btRigidBody& body, double damping) { return impl_->share(body, damping); }
void Site::connect(PeerId remote, Link& link, const Vec3& start_W) {
  impl_->connect(remote, link, start_W);
}
std::uint32_t Site::tick(double now) noexcept { return impl_->tick(now); }
void Site::betweenTicks(const std::function<void()>& work) { impl_->desk.run(work); }
std::uint32_t Site::status() const noexcept { return impl_->status_ever | impl_->status_of_host; }
bool Site::isWorldGone() const noexcept { return (impl_->status_of_host & kWorldGone) != 0; }
const SiteCounters& Site::counters() const noexcept { return impl_->counters; }
const IslandCounters& Site::islandCounters() const noexcept { return impl_->island.counters(); }
std::uint64_t Site::tickCount() const noexcept { return impl_->ticks; }
std::uint64_t Site::stateHash() const noexcept { return impl_->hash.value(); }
const Vec3& Site::force() const noexcept { return impl_->force_W; }
const RigidState& Site::hip() const noexcept { return impl_->island.state(impl_->hip); }
int Site::objectCount() const noexcept { return static_cast<int>(impl_->objects.size()); }
int Site::remoteCount() const noexcept { return static_cast<int>(impl_->remotes.size()); }
int Site::neighbourCount() const noexcept {
  return static_cast<int>(
      std::count_if(impl_->neighbours.begin(), impl_->neighbours.end(),
                    [](const Neighbour& neighbour) { return neighbour.rigid != nullptr; }));
}
void Site::record(Recording* recording) noexcept { impl_->recording = recording; }

const RigidState& Site::object(ObjectId id) const noexcept {
  return impl_->island.state(impl_->objects[id].body.index);
}

const RigidState* Site::proxy(int remote) const noexcept {
  const Remote& r = impl_->remotes[remote];
  return r.user.body ? &impl_->island.state(*r.user.body) : nullptr;
}

btRigidBody* Site::proxyBody(int remote) const noexcept {
  return impl_->findProxyBody(impl_->remotes[remote]);
}

btRigidBody& Site::objectBody(ObjectId id) const noexcept { return *impl_->objects[id].rigid; }
LinkState Site::linkState(int remote) const noexcept {
  return impl_->remotes[remote].health.state();
}
const PassivityObserver& Site::passivity() const noexcept { return impl_->passivity; }
const StatePacket& Site::latest(int remote) const noexcept { return impl_->remotes[remote].latest; }

std::vector<std::string> Site::warnings() const {
  std::vector<std::string> all = impl_->host_world.warnings();
  all.insert(all.end(), impl_->last_warnings.begin(), impl_->last_warnings.end());
  impl_->forEachBody([&](SiteBody& body) {
    if (!body.bullet) return;
    const auto& own = body.bullet->warnings();
    all.insert(all.end(), own.begin(), own.end());
  });
  return all;
}

}  // namespace tandem
