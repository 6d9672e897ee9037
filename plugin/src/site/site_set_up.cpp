#include <algorithm>
#include <stdexcept>
#include <utility>

#include "tandem/bullet_bridge/shapes.h"

#include "bullet_bridge/src/world/world_access.h"
#include "coordination/src/bad_value.h"
#include "site/site_impl.h"

namespace tandem {
namespace {

/// Limits of a live host: the oldest state it asks for, besides stalls [s], and its fastest step
/// rate [Hz].
constexpr double kLongestHorizon = 0.25, kFastestHost = 240.0;
constexpr double kMostMoments = 2048.0;

}  // namespace

Site::Impl::Impl(const SiteSettings& wanted, btDiscreteDynamicsWorld& world, HapticDevice& device,
                 BulletAbi abi)
    : SiteParts(wanted, world, device, abi, *this), host_step(makeHostStep(*this)) {
  finishSetUp();
}

// Proxies remove their contact filters themselves.
Site::Impl::~Impl() { host_step->leaveNeighbours(); }

void Site::Impl::checkOpenToSetUp() {
  if (host_world.hasEnded())
    throw Error(
        "the Bullet world of this site has been destroyed; make a new Site for another world, and "
        "destroy a site before its world");
  if (desk.isOpen())
    throw Error("a site is set up before its HapticLoop begins; stop that, and begin another one");
  if (!host_step->areBodiesPresent())
    throw Error(
        "a body of this site was taken out of its Bullet world; destroy the site and make a new "
        "one");
}

void Site::Impl::checkShareable(const btRigidBody& rigid) const {
  for (const SharedObject& object : bodies.objects)
    if (object.rigid == &rigid)
      throw Error("the body is shared already, as object " + std::to_string(object.id) +
                  "; share each body once");
  for (const Peer& peer : peers)
    if (peer.proxy.findRigid() == &rigid)
      throw Error("the body stands for a remote user; share a body of the host's own");
}

ObjectId Site::Impl::share(btRigidBody& rigid, double damping) {
  SharedObject object;
  object.damping = damping;
  return add(std::move(object), rigid);
}

ObjectId Site::Impl::shareTool(btRigidBody& rigid, PeerId user, const Vec3& at_B) {
  checkPlace(at_B);
  checkCanHold();
  if (user == settings.self && grips.isBusy())
    throw Error("the hand holds something already; release it first");
  SharedObject tool;
  tool.tool_of = user;
  const ObjectId id = add(std::move(tool), rigid);
  if (user == settings.self) grips.grab(bodies.objects[id], at_B);
  return id;
}

/// Adds an object with the values that its body does not tell.
ObjectId Site::Impl::add(SharedObject object, btRigidBody& rigid) {
  checkOpenToSetUp();
  if (bodies.objects.size() == kMaxSharedObjects)
    throw Error("a site shares at most " + std::to_string(kMaxSharedObjects) + " objects");
  checkShareable(rigid);
  const Shape shape = getShareableShape(rigid);
  host_step->leaveNeighbours();  // the body may be a neighbour

  object.id = static_cast<ObjectId>(bodies.objects.size());
  object.rigid = &rigid;
  object.mass_share = peers.findMassShare(object.tool_of);
  object.hold(host_world.world(), shape);
  host_step->checkObject(object.settings.mass);
  object.body.index = island.addBody(object.settings);
  object.body.is_held = true;
  host_step->addObject(object);
  bodies.objects.push_back(std::move(object));
  tieObjects();
  finishSetUp();
  return bodies.objects.back().id;
}

SharedObject& Site::Impl::findObject(ObjectId id) {
  if (settings.guide || settings.contact_model != ContactModel::kIsland)
    throw Error(
        "with a guide or a native model the objects stay as they were set up; destroy the site and "
        "make a new one");
  if (host_world.hasEnded() || has_given_back_)
    throw Error("this site has stopped and holds no object; destroy it and make a new one");
  if (id >= bodies.objects.size())
    throw Error("there is no object " + std::to_string(id) + "; this site has " +
                std::to_string(bodies.objects.size()));
  return bodies.objects[id];
}

void Site::Impl::unshare(ObjectId id) {
  SharedObject& object = findObject(id);
  if (!object.rigid) return;
  rest.disturb();
  objects.leaveOne(object);
  desk.run([&] {
    surroundings.takeObstacles();
    objects.takeLeaving();
  });
  objects.giveBack(true);
  desk.run([&] { objects.forget(object); });
}

void Site::Impl::share(ObjectId id, btRigidBody& rigid) {
  SharedObject& object = findObject(id);
  int hint = -1;
  if (object.rigid && findRigidBody(host_world.world(), object.rigid, hint))
    throw Error("object " + std::to_string(id) + " has a body in the world; unshare it first");
  checkShareable(rigid);
  static_cast<void>(getShareableShape(rigid));
  HapticBody::checkAttachable(host_world.world(), rigid);
  host_step->checkObject(object.mass_share / static_cast<double>(rigid.getInvMass()));
  host_step->leaveNeighbours();  // the body may be a neighbour
  unshare(id);
  objects.expect(object, rigid);
}

void Site::Impl::connect(PeerId id, Link& link, const Vec3& start_W) {
  checkOpenToSetUp();
  if (id == settings.self)
    throw std::invalid_argument("a site cannot be its own remote; give each peer its own id");
  if (settings.membership.follows && !SiteSet::all().has(id))
    throwBadValue("id of a remote, with membership.follows", static_cast<std::uint32_t>(id),
                  "1 to 64");
  Peer peer = peers.make(id, link, start_W);
  if (peer.user.body) host_step->addProxy(peer, start_W);
  host_step->leaveNeighbours();
  grips.addPeer(peer);
  peers.add(std::move(peer));
  tieObjects();
  finishSetUp();
}

void Site::Impl::tieObjects() {
  for (SharedObject& object : bodies.objects) {
    peers.tie(object, [&](CouplerIndex index, const CouplerSettings& coupler) {
      host_step->addCoupler(object, index, coupler);
    });
  }
}

void Site::Impl::finishSetUp() {
  rest.disturb();
  island.prepare();
  listBodies();
  timeline.setBodyCount(static_cast<std::size_t>(island.bodyCount()));
  hand.forgetRest();
  log.makeRoom(bodies.objects.size(), static_cast<std::size_t>(peers.count()));
  sender.setSize(bodies.objects.size(), static_cast<std::size_t>(peers.count()));
  surroundings.makeRoom();
  press.makeRoom();
  bodies.forEach([](SiteBody& body) {
    body.load.makeRoom();
    body.bullet->remember();
  });
  host_step->finishSetUp();
}

void Site::Impl::listBodies() {
  bodies.clearList();
  for (SharedObject& object : bodies.objects) bodies.list(object.body);
  for (Neighbour& neighbour : surroundings.neighbours()) bodies.list(neighbour.body);
  for (Peer& peer : peers) {
    if (!peer.proxy.sphere) continue;
    peer.proxy.body.is_held = true;
    bodies.list(peer.proxy.body);
  }
}

void Site::Impl::beginLive() {
  host_step->beginLive();
  bodies.forEachPresent([](SiteBody& body) { body.seen = body.bullet->state(); });
  // A live host's steps are irregular, so room for all states that it may ask for is made now.
  const double moments = (kLongestHorizon + settings.host_stall) * kFastestHost;
  timeline.makeRoom(static_cast<std::size_t>(std::min(moments, kMostMoments)));
}

}  // namespace tandem
