#include "c/site.h"

#include <algorithm>
#include <stdexcept>

#include "bullet_bridge/src/world/world_access.h"
#include "c/values.h"

namespace tandem::c_door {
namespace {

/// A body that may be shared. `own` is the body that its object has now.
[[nodiscard]] WorldBody& findShareable(const World& world, TandemBody body,
                                       TandemBody own = TANDEM_NO_BODY) {
  WorldBody& known = world.body(body);
  if (known.is_shared && body != own)
    throw Error("body " + std::to_string(body) + " is shared already, or a proxy; share it once");
  // Site would record a static body before it refuses it.
  if (!isDynamic(*known.rigid))
    throw Error("body " + std::to_string(body) + " is static; give a shared object a mass");
  return known;
}

}  // namespace

SiteEnd::SiteEnd(const SiteSettings& settings, TandemWorld& world, TandemDevice& device)
    : world_(*world.thing),
      world_use_(world.head),
      device_use_(device.head),
      ticks_itself_(settings.tick_source == TickSource::kHostStep),
      site_(settings, world_.bullet(), device.thing->haptic, world_.abi()) {
  world_.watch(&site_);
}

SiteEnd::~SiteEnd() {
  stopLoop();
  world_.watch(nullptr);
  for (const TandemBody body : shared_)
    if (body != TANDEM_NO_BODY) world_.release(body);
  for (const TandemBody proxy : proxies_) world_.forget(proxy);
}

void SiteEnd::checkSetUp(const char* what) const {
  (void)world_.bullet();
  if (loop_)
    throw Error(std::string(what) +
                " is set-up; stop the loop first, and start another one afterwards");
}

void SiteEnd::checkObject(std::uint32_t object) const {
  (void)world_.bullet();
  if (object >= shared_.size())
    throw std::invalid_argument("there is no object " + std::to_string(object) +
                                "; this site has " + std::to_string(shared_.size()));
}

template <typename Share>
ObjectId SiteEnd::shareBody(TandemBody body, Share share) {
  checkSetUp("sharing a body");
  WorldBody& known = findShareable(world_, body);
  shared_.reserve(shared_.size() + 1);
  const ObjectId object = share(*known.rigid);
  shared_.push_back(body);
  known.is_shared = true;
  return object;
}

ObjectId SiteEnd::share(TandemBody body, double damping) {
  requireNotNegative("damping", damping);
  return shareBody(body, [&](btRigidBody& rigid) { return site_.share(rigid, damping); });
}

ObjectId SiteEnd::shareTool(TandemBody body, std::uint32_t user, const Vec3& at_B) {
  return shareBody(body,
                   [&](btRigidBody& rigid) { return site_.shareTool(rigid, PeerId{user}, at_B); });
}

void SiteEnd::unshare(std::uint32_t object) {
  checkObject(object);
  site_.unshare(object);
  if (shared_[object] != TANDEM_NO_BODY) world_.release(shared_[object]);
  shared_[object] = TANDEM_NO_BODY;
}

void SiteEnd::shiftOrigin(const Vec3& offset_W) {
  (void)world_.bullet();
  if (world_.isOwn())
    throw Error(
        "a world of Tandem's keeps its origin; only a host's own Bullet world can be shifted");
  site_.shiftOrigin(offset_W);
}

void SiteEnd::grab(std::uint32_t object, const std::optional<Vec3>& at_B) {
  checkObject(object);
  site_.grab(object, at_B);
}

void SiteEnd::release() {
  (void)world_.bullet();
  site_.release();
}

void SiteEnd::shareAgain(std::uint32_t object, TandemBody body) {
  checkObject(object);
  WorldBody& known = findShareable(world_, body, shared_[object]);
  site_.share(object, *known.rigid);
  if (shared_[object] != TANDEM_NO_BODY) world_.release(shared_[object]);
  shared_[object] = body;
  known.is_shared = true;
}

TandemObjectState SiteEnd::objectState(std::uint32_t object) const {
  checkObject(object);
  if (!site_.isShared(object)) return TANDEM_OBJECT_UNSHARED;
  if (site_.isHeld(object)) return TANDEM_OBJECT_HELD;
  int hint = -1;
  const bool is_there = findRigidBody(world_.bullet(), &site_.objectBody(object), hint) != nullptr;
  return is_there ? TANDEM_OBJECT_LEFT : TANDEM_OBJECT_MISSING;
}

TandemBody SiteEnd::connect(std::uint32_t peer, TandemLink& link, const Vec3& start_W) {
  checkSetUp("connecting a remote");
  if (peer == 0) refuseValue("peer", 0, "1 or more");
  if (std::find(peers_.begin(), peers_.end(), peer) != peers_.end())
    throw Error("peer " + std::to_string(peer) + " is connected already; connect each once");
  if (link.head.users > 0)
    throw Refusal(TANDEM_IN_USE, "the link is connected already; each remote has one of its own");
  peers_.reserve(peers_.size() + 1);
  link_uses_.reserve(link_uses_.size() + 2);
  mesh_ways_.reserve(mesh_ways_.size() + 1);
  proxies_.reserve(proxies_.size() + 1);
  world_.reserveNumber();
  site_.connect(PeerId{peer}, *link.thing->link, start_W);
  peers_.push_back(peer);
  link_uses_.emplace_back(link.head);
  has_simulated_link_ |= link.thing->is_simulated;
  if (const auto& way = link.thing->mesh) {
    mesh_ways_.push_back(*way);
    link_uses_.emplace_back(*way->mesh);
  }
  btRigidBody* proxy = site_.proxyBody(site_.remoteCount() - 1);
  if (!proxy) return TANDEM_NO_BODY;
  proxies_.push_back(world_.number(*proxy));
  world_.body(proxies_.back()).is_shared = true;
  return proxies_.back();
}

std::uint32_t SiteEnd::tick(double now) {
  if (ticks_itself_)
    throw std::invalid_argument(
        "the site ticks itself in the world's steps; make it with TANDEM_TICK_CALLER");
  if (loop_)
    throw Refusal(TANDEM_IN_USE, "the site is ticked by its loop; call tandem_site_stop_loop()");
  requireFinite("now", now);
  if (now <= last_tick_) refuseValue("now", now, "later than at the tick before");
  last_tick_ = now;
  return site_.tick(now);
}

void SiteEnd::startLoop(int priority) {
  (void)world_.bullet();
  if (loop_) throw Error("the site has a loop already; stop that first");
  if (has_simulated_link_)
    throw Error(
        "a simulated link belongs to the thread of both its sites; connect a loop's site by a mesh "
        "or a manual link");
  HapticLoopSettings settings;
  settings.priority = priority;
  settings.locks_memory = priority > 0;
  for (const MeshWay& way : mesh_ways_) way.setLoop(true);
  try {
    loop_ = std::make_unique<HapticLoop>(site_, settings);
  } catch (...) {
    for (const MeshWay& way : mesh_ways_) way.setLoop(false);
    throw;
  }
}

void SiteEnd::stopLoop() noexcept {
  if (!loop_) return;
  loop_.reset();
  for (const MeshWay& way : mesh_ways_) way.setLoop(false);
}

std::vector<std::string> SiteEnd::warnings() const {
  std::vector<std::string> all = site_.warnings();
  if (loop_) all.insert(all.end(), loop_->notes().begin(), loop_->notes().end());
  return all;
}

}  // namespace tandem::c_door
