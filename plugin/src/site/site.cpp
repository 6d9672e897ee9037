#include "tandem/plugin/site.h"

#include <cmath>

#include "site/site_impl.h"

namespace tandem {
namespace {

/// Later times have too few digits left for a period [s].
constexpr double kLatest = 1e10;

}  // namespace

Site::Site(const SiteSettings& settings, btDiscreteDynamicsWorld& world, HapticDevice& device,
           BulletAbi host)
    : impl_(std::make_unique<Impl>(settings, world, device, host)) {}
Site::~Site() = default;

ObjectId Site::share(btRigidBody& body, double damping) { return impl_->share(body, damping); }
std::vector<ObjectId> Site::share(const std::vector<NamedBody>& bodies) {
  return impl_->share(bodies);
}
ObjectId Site::shareTool(btRigidBody& body, PeerId user, const Vec3& at_B) {
  return impl_->shareTool(body, user, at_B);
}
void Site::share(ObjectId id, btRigidBody& body) { impl_->share(id, body); }
void Site::unshare(ObjectId id) { impl_->unshare(id); }
void Site::shiftOrigin(const Vec3& offset_W) { impl_->shiftOrigin(offset_W); }
void Site::grab(ObjectId object, const std::optional<Vec3>& at_B) { impl_->grab(object, at_B); }
void Site::release() noexcept { impl_->release(); }
std::optional<Grip> Site::grip() const noexcept { return impl_->grips.grip(); }
void Site::connect(PeerId remote, Link& link, const Vec3& start_W) {
  impl_->connect(remote, link, start_W);
}
std::uint32_t Site::tick(double now) noexcept {
  const bool is_time = std::abs(now) <= kLatest;
  return impl_->tick(is_time ? now : impl_->timeline.nextTick(0.0), kMostMadeUp);
}
void Site::betweenTicks(const std::function<void()>& work) { impl_->desk.run(work); }
void Site::record(Recording* recording) noexcept { impl_->log.recording = recording; }

std::uint32_t Site::status() const noexcept { return impl_->log.status(); }
bool Site::isWorldGone() const noexcept { return impl_->log.isWorldGone(); }
const SiteCounters& Site::counters() const noexcept {
  impl_->log.countForces(impl_->hand);
  return impl_->log.counters;
}
const IslandCounters& Site::islandCounters() const noexcept { return impl_->island.counters(); }
std::uint64_t Site::tickCount() const noexcept { return impl_->timeline.ticks(); }
std::uint64_t Site::stateHash() const noexcept { return impl_->log.hash(); }
std::vector<std::string> Site::warnings() const { return impl_->warnings(); }

const Vec3& Site::force() const noexcept { return impl_->hand.force(); }
const Vec3& Site::torque() const noexcept { return impl_->hand.torque(); }
const PassivityObserver& Site::passivity() const noexcept {
  return impl_->hand.energy().observer();
}
const RigidState& Site::hip() const noexcept { return impl_->island.state(impl_->hand.hip()); }

int Site::objectCount() const noexcept { return static_cast<int>(impl_->bodies.objects.size()); }
const RigidState& Site::object(ObjectId id) const noexcept {
  return impl_->island.state(impl_->bodies.objects[id].body.index);
}
bool Site::isShared(ObjectId id) const noexcept {
  return impl_->bodies.objects[id].rigid != nullptr;
}
bool Site::isHeld(ObjectId id) const noexcept {
  const SiteBody& body = impl_->bodies.objects[id].body;
  return body.is_held && !body.is_leaving;
}
btRigidBody& Site::objectBody(ObjectId id) const noexcept {
  return *impl_->bodies.objects[id].rigid;
}
int Site::neighbourCount() const noexcept { return impl_->surroundings.neighbourCount(); }

int Site::remoteCount() const noexcept { return impl_->peers.count(); }
int Site::memberCount() const noexcept { return impl_->peers.countSites(); }
const RigidState* Site::proxy(int remote) const noexcept {
  const Peer& peer = impl_->peers[remote];
  return peer.user.body ? &impl_->island.state(*peer.user.body) : nullptr;
}
btRigidBody* Site::proxyBody(int remote) const noexcept {
  return impl_->peers[remote].proxy.findRigid();
}
LinkState Site::linkState(int remote) const noexcept { return impl_->peers[remote].health.state(); }
const StatePacket& Site::latest(int remote) const noexcept { return impl_->peers[remote].latest; }

}  // namespace tandem
