#include "tandem/plugin/site.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "tandem/bullet_bridge/shapes.h"

#include "site_impl.h"

namespace tandem {
namespace {

/// Until the host's step is known [s].
constexpr double kUsualHostStep = 1.0 / 60.0;

SiteSettings checked(const SiteSettings& settings) {
  checkSiteSettings(settings);
  return settings;
}

IslandSettings makeIslandSettings(const SiteSettings& settings) {
  IslandSettings island;
  island.haptic_period = 1.0 / settings.haptic_rate;
  island.inner_step = settings.inner_step;
  island.guide = settings.guide;
  island.obstacle_contact = settings.contact;
  return island;
}

}  // namespace

Site::Impl::Impl(const SiteSettings& wanted, btDiscreteDynamicsWorld& host, HapticDevice& hand,
                 BulletAbi abi)
    : settings(checked(wanted)),
      scheme(wanted.scheme ? *wanted.scheme : findScheme("remote_dynamic_proxy")),
      device(hand),
      host_world(host, *this, abi),
      obstacles(host),
      neighbour_search(host, static_cast<std::size_t>(settings.max_neighbours)),
      island(makeIslandSettings(settings)),
      guard(hand.capabilities().max_force,
            std::min(settings.max_slew, hand.capabilities().max_slew) / settings.haptic_rate,
            settings.fault_slew / settings.haptic_rate),
      passivity(settings.passivity),
      host_step(settings.host_step),
      standing_watch(host) {
  IslandBody body;
  body.shape = Sphere{settings.hip_radius};
  body.motion = Motion::kPrescribed;
  body.feels_obstacles = true;
  sample = device.read(0.0);
  if (!sample.valid || !isFinite(sample.hip))
    throw Error("the device gives no position; check its cable, or wait until it is homed");
  body.start.p_W = sample.hip.p_W;
  hip = island.addBody(body);
  if (settings.contact_model != ContactModel::kIsland)
    native = std::make_unique<NativeModel>(host, settings, body.start.p_W);
  obstacles.addSphere(hip, settings.hip_radius);
  if (isHandoff()) island.setContactFinder(&obstacles);
  if (isHandoff() && !settings.guide && !native) {
    neighbours.resize(static_cast<std::size_t>(settings.max_neighbours));
    for (Neighbour& neighbour : neighbours) neighbour.body.index = island.addSlot();
  }
  handoff_due = host_step > 0.0 ? host_step : std::numeric_limits<double>::infinity();
  finishSetUp();
}

// Proxies take the filters of their contacts along.
Site::Impl::~Impl() { demoteAll(); }

void Site::Impl::checkNotLive() const {
  if (desk.isOpen())
    throw Error("a site is set up before its HapticLoop begins; stop that, and begin another one");
}

ObjectId Site::Impl::share(btRigidBody& rigid, double damping) {
  checkNotLive();
  if (objects.size() == kMaxSharedObjects)
    throw Error("a site shares at most " + std::to_string(kMaxSharedObjects) + " objects");
  const Shape shape = getShareableShape(rigid);
  demoteAll();
  neighbour_search.exclude(rigid);

  SharedObject object;
  object.id = static_cast<ObjectId>(objects.size());
  object.damping = damping;
  object.bounding_radius = computeBoundingRadius(shape);
  object.bullet = std::make_unique<HapticBody>(host_world.world(), rigid,
                                               1.0 / static_cast<double>(settings.peers));
  object.body.bullet = object.bullet.get();
  const HapticBody& bullet = *object.bullet;

  IslandBody body;
  body.shape = shape;
  body.mass = bullet.mass();
  body.inertia_B = bullet.inertia();
  body.damping = damping;
  body.is_rigid = true;
  body.start = bullet.state();
  checkInjectionStable("shared object",
                       settings.contact.stiffness + settings.coordination.stiffness,
                       settings.contact.damping + settings.coordination.damping, body.mass);
  object.body.index = island.addBody(body);
  if (isHandoff() && !settings.guide) obstacles.addBody(object.body.index, rigid);

  if (native)
    native->addObject(bullet, damping);
  else
    island.addContact(hip, object.body.index, settings.contact);
  for (Remote& remote : remotes) {
    if (!remote.proxy || native) continue;
    island.addContact(*remote.user.body, object.body.index, settings.contact);
    filterNativeContact(host_world.world(), remote.proxy->rigid(), rigid, true);
  }
  coordinate(object);
  objects.push_back(std::move(object));
  finishSetUp();
  return objects.back().id;
}

void Site::Impl::connect(PeerId peer, Link& link, const Vec3& start_W) {
  checkNotLive();
  if (peer == settings.self)
    throw std::invalid_argument("a site cannot be its own remote; give each peer its own id");
  Remote remote;
  remote.id = peer;
  remote.link = &link;
  remote.health = LinkHealth(settings.link_loss, 1.0 / settings.packet_rate);
  remote.link_state = remote.health.state();
  remote.track.jump({start_W, Vec3::Zero()});
  remote.searched_W = start_W;
  remote.user =
      scheme.makeRemoteUser(island, settings.proxy, settings.coordination, {start_W, Vec3::Zero()});
  if (remote.user.body && native) {
    addNativeProxy(remote, start_W);
  } else if (remote.user.body) {
    const BodyIndex index = *remote.user.body;
    checkInjectionStable("proxy", settings.contact.stiffness + settings.coordination.stiffness,
                         settings.contact.damping + settings.coordination.damping,
                         settings.proxy.mass);
    remote.proxy = std::make_unique<SphereBody>(host_world.world(), settings.proxy.radius,
                                                settings.proxy.mass, start_W);
    neighbour_search.exclude(remote.proxy->rigid());
    remote.body.bullet = &remote.proxy->haptic();
    remote.body.index = index;
    obstacles.addSphere(index, settings.proxy.radius);
    island.addContact(hip, index, settings.contact);
    for (SharedObject& object : objects) {
      island.addContact(index, object.body.index, settings.contact);
      filterNativeContact(host_world.world(), remote.proxy->rigid(), object.bullet->body(), true);
    }
  }
  demoteAll();
  remotes.push_back(std::move(remote));
  for (SharedObject& object : objects) coordinate(object);
  finishSetUp();
}

/// Ties an object copy to the copies of all remotes: eqs (9), (10).
void Site::Impl::coordinate(SharedObject& object) {
  const HapticBody& bullet = *object.bullet;
  CouplerSettings coupler{settings.coordination, {}};
  const double radius_squared = bullet.inertia().maxCoeff() / bullet.mass();
  coupler.angular = settings.angular_coordination.value_or(
      CouplerGains{settings.coordination.stiffness * radius_squared,
                   settings.coordination.damping * radius_squared});
  while (object.couplers.size() < remotes.size()) {
    object.couplers.push_back(island.addCoupler(object.body.index, coupler));
    object.theirs.push_back(island.state(object.body.index));
    object.detours.emplace_back();
    if (native) native->addCoupler(object.bullet->body(), object.couplers.back(), coupler);
  }
}

void Site::Impl::checkInjectionStable(const char* what, double stiffness, double damping,
                                      double mass) const {
  const double limit = computeInjectionStepLimit(stiffness, damping, mass);
  if (native || isHandoff() || period() < limit) return;
  std::ostringstream message;
  message << "impulse injection is unstable for the " << what << ": the step of " << period()
          << " s is above its limit of " << limit << " s for K = " << stiffness
          << " N/m, B = " << damping << " N s/m, m = " << mass
          << " kg; use hand-off, lower the gains or raise the haptic rate";
  throw std::invalid_argument(message.str());
}

void Site::Impl::finishSetUp() {
  may_skip = false;
  island.prepare();
  const auto count = static_cast<std::size_t>(island.bodyCount());
  snapshots.setBodyCount(count);
  tick_start_states.resize(count);
  moved_last.reserve(count);
  mirror.states.resize(count);
  mirror.moves.resize(count);
  newcomers.reserve(neighbours.size());
  packet_turns.setObjectCount(objects.size());
  for (Remote& remote : remotes) remote.object_sequences.resize(objects.size());
  for (RestMark* mark : {&force_rest, &hash_rest, &start_rest, &snapshot_rest, &quiet_rest})
    mark->clear();
  from_states.resize(count);
  to_states.resize(count);
  asides.resize(count);
  leaving.reserve(neighbours.size());
  object_records.resize(objects.size());
  proxy_records.resize(remotes.size());
  for (Neighbour& neighbour : neighbours) neighbour.body.given.reserve(kGivenImpulses);
  forEachBody([&](SiteBody& body) {
    body.given.reserve(kGivenImpulses);
    body.bullet->remember();
    body.f_gravity_W = body.bullet->gravityForce();
    setWorldWrench(body.index, isHandoff() ? body.f_gravity_W : Vec3::Zero(), Vec3::Zero());
  });
  if (native) return;
  const double step = host_step > 0.0 ? host_step : kUsualHostStep;
  makeRoomFor(step);
  mirrorIsland();
  updateSurroundings(step);
}

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
  const Remote& r = impl_->remotes[remote];
  if (r.held_proxy) return &r.held_proxy->rigid();
  return r.proxy ? &r.proxy->rigid() : nullptr;
}

btRigidBody& Site::objectBody(ObjectId id) const noexcept {
  return impl_->objects[id].bullet->body();
}
LinkState Site::linkState(int remote) const noexcept {
  return impl_->remotes[remote].health.state();
}
const PassivityObserver& Site::passivity() const noexcept { return impl_->passivity; }
const StatePacket& Site::latest(int remote) const noexcept { return impl_->remotes[remote].latest; }

std::vector<std::string> Site::warnings() const {
  std::vector<std::string> all;
  impl_->forEachBody([&](SiteBody& body) {
    const auto& own = body.bullet->warnings();
    all.insert(all.end(), own.begin(), own.end());
  });
  return all;
}

}  // namespace tandem
