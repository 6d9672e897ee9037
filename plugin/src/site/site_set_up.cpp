#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "tandem/bullet_bridge/shapes.h"

#include "site/site_impl.h"

namespace tandem {
namespace {

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

void Site::Impl::checkOpenToSetUp() {
  if (host_world.hasEnded())
    throw Error(
        "the Bullet world of this site has been destroyed; make a new Site for another world, and "
        "destroy a site before its world");
  if (desk.isOpen())
    throw Error("a site is set up before its HapticLoop begins; stop that, and begin another one");
  if (!allBodiesPresent())
    throw Error(
        "a body of this site was taken out of its Bullet world; destroy the site and make a new "
        "one");
}

ObjectId Site::Impl::share(btRigidBody& rigid, double damping) {
  checkOpenToSetUp();
  if (objects.size() == kMaxSharedObjects)
    throw Error("a site shares at most " + std::to_string(kMaxSharedObjects) + " objects");
  for (const SharedObject& object : objects)
    if (object.rigid == &rigid)
      throw Error("the body is shared already, as object " + std::to_string(object.id) +
                  "; share each body once");
  for (const Remote& remote : remotes)
    if (findProxyBody(remote) == &rigid)
      throw Error("the body stands for a remote user; share a body of the host's own");
  const Shape shape = getShareableShape(rigid);
  demoteAll();  // it may be among them

  SharedObject object;
  object.id = static_cast<ObjectId>(objects.size());
  object.rigid = &rigid;
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
  neighbour_search.exclude(rigid);
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
  checkOpenToSetUp();
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
  const double step = expectedHostStep();
  makeRoomFor(step);
  mirrorIsland();
  updateSurroundings(step);
}

}  // namespace tandem
