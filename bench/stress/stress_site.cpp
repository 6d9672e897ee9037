#include "bench/stress/stress_site.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tandem/bullet_bridge/convert.h"

#include "bench/methods/bullet_scene.h"

namespace tandem::demos::bench {
namespace {

/// Peers that carry a shared body; the host's body has the mass of all copies.
constexpr int kPeers = 2;

/// Largest number of looks in a tick.
constexpr int kMostLooks = 1000;

/// Overlap of rigid bodies below this is rounding [m].
constexpr double kLeastOverlap = 1e-6;

/// A device that follows its script under any force.
class ScriptedDevice final : public HapticDevice {
 public:
  explicit ScriptedDevice(const StressPath& path) : path_(path) {
    capabilities_.name = "scripted";
    capabilities_.is_continuous = true;
  }
  const DeviceCapabilities& capabilities() const noexcept override { return capabilities_; }
  DeviceSample read(double now) noexcept override { return {path_.at(now), true}; }
  void write(const Vec3&) noexcept override {}

 private:
  const StressPath& path_;
  DeviceCapabilities capabilities_;
};

/// Packets of a scripted user, without delay; its objects stand as in `start`.
class ScriptedLink final : public Link {
 public:
  ScriptedLink(const StressPath& path, const StatePacket& start, double rate)
      : path_(path), rate_(rate), packet_(start) {}
  void send(const StatePacket&, double) noexcept override {}
  std::optional<Arrival> receive(double, double until) noexcept override {
    const double time = next_ / rate_;
    if (time >= until) return std::nullopt;
    packet_.sequence = static_cast<std::uint64_t>(next_);
    packet_.time = time;
    packet_.user = path_.at(time);
    ++next_;
    return Arrival{packet_, time};
  }

 private:
  const StressPath& path_;
  double rate_;
  double next_ = 0.0;
  StatePacket packet_;
};

/// Turn in an inner step beyond which a pin may open [rad].
constexpr double kMostTurn = 0.3;

/// Links of chains collide with all but each other.
constexpr int kLinkGroup = 1 << 8;

btVector3 toFrame(const btRigidBody& body, const btVector3& p_W) {
  return body.getCenterOfMassTransform().inverse() * p_W;
}
btVector3 turnToFrame(const btRigidBody& body, const btVector3& n_W) {
  return body.getCenterOfMassTransform().getBasis().transpose() * n_W;
}

PeerId peerOf(std::size_t user) { return PeerId{static_cast<std::uint32_t>(user) + 1}; }

std::unique_ptr<btCollisionShape> makeShape(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape))
    return std::make_unique<btBoxShape>(toBullet(box->half_extents));
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    return std::make_unique<btSphereShape>(static_cast<btScalar>(sphere->radius));
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return std::make_unique<btCapsuleShape>(static_cast<btScalar>(capsule->radius),
                                            static_cast<btScalar>(2.0 * capsule->half_length));
  const auto& plane = std::get<Plane>(shape);
  return std::make_unique<btStaticPlaneShape>(toBullet(plane.normal_B),
                                              static_cast<btScalar>(plane.offset));
}

}  // namespace

StressSite::StressSite(const StressCase& one, std::size_t self, const std::vector<Link*>& links)
    : case_(one), user_(one.users[self]), self_(self), watch_(findScheme(one.scheme)) {
  world_.setGravity(toBullet(one.gravity_W));
  for (const StressBody& body : one.bodies) addBody(body);
  for (const StressJoint& joint : one.joints) addJoint(joint);
  const double overlap = findRigidOverlap();
  makeDevice();
  site_ = std::make_unique<Site>(makeSettings(), world_, *device_);
  for (std::size_t b = 0; b < one.bodies.size(); ++b)
    if (one.bodies[b].is_shared) site_->share(*bodies_[b], one.object_damping);
  scene_.gravity_W = one.gravity_W;
  scene_.origin_W = one.origin_W;
  scene_.contact = one.contact;
  scene_.guide = one.guide;
  scene_.haptic_period = 1.0 / one.haptic_rate;
  for (const StressBody& body : one.bodies) scene_.is_free = scene_.is_free && body.mass > 0.0;
  scene_.has_overlap = overlap > kLeastOverlap || one.kind == StressKind::kNeighbours;
  connect(links);
  account_ = std::make_unique<EnergyAccount>(*watch_.island(), scene_);
  account_->look(0.0);
  watch_.setAccount(account_.get());
}

StressSite::~StressSite() {
  site_.reset();
  for (const auto& joint : joints_) world_.removeConstraint(joint.get());
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
}

void StressSite::addBody(const StressBody& body) {
  shapes_.push_back(makeShape(body.shape));
  const auto mass = static_cast<btScalar>(body.mass * (body.is_shared ? kPeers : 1));
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shapes_.back()->calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shapes_.back().get(), inertia);
  info.m_startWorldTransform = toBullet(body.start.p_W, body.start.q_WB);
  info.m_friction = static_cast<btScalar>(std::sqrt(case_.friction));
  bodies_.push_back(std::make_unique<btRigidBody>(info));
  btRigidBody& rigid = *bodies_.back();
  rigid.setLinearVelocity(toBullet(body.start.v_W));
  rigid.setAngularVelocity(toBullet(body.start.w_W));
  if (case_.joints.empty()) return world_.addRigidBody(&rigid);
  rigid.setSleepingThresholds(0, 0);
  world_.addRigidBody(&rigid, kLinkGroup, btBroadphaseProxy::AllFilter ^ kLinkGroup);
}

void StressSite::addJoint(const StressJoint& joint) {
  btRigidBody& a = *bodies_[joint.a];
  btRigidBody* b = joint.b ? bodies_[*joint.b].get() : nullptr;
  const btVector3 pin_W = toBullet(joint.pin_W), at_A = toFrame(a, pin_W);
  if (joint.axis_W) {
    const btVector3 axis_W = toBullet(*joint.axis_W);
    joints_.push_back(b ? std::make_unique<btHingeConstraint>(a, *b, at_A, toFrame(*b, pin_W),
                                                              turnToFrame(a, axis_W),
                                                              turnToFrame(*b, axis_W))
                        : std::make_unique<btHingeConstraint>(a, at_A, turnToFrame(a, axis_W)));
  } else {
    joints_.push_back(b ? std::make_unique<btPoint2PointConstraint>(a, *b, at_A, toFrame(*b, pin_W))
                        : std::make_unique<btPoint2PointConstraint>(a, at_A));
  }
  world_.addConstraint(joints_.back().get(), true);
}

bool StressSite::spinsWildly() const {
  for (BodyIndex b = 0; b < island().bodyCount(); ++b)
    if (island().state(b).w_W.norm() * SiteSettings{}.inner_step > kMostTurn) return true;
  return false;
}

double StressSite::measurePins() const {
  double largest = 0.0;
  for (const StressJoint& joint : case_.joints) {
    const auto place = [&](std::size_t body) {
      const RigidState now = stateOf(*bodies_[body]), &start = case_.bodies[body].start;
      return Vec3(now.p_W + now.q_WB * (start.q_WB.conjugate() * (joint.pin_W - start.p_W)));
    };
    const Vec3 other_W = joint.b ? place(*joint.b) : joint.pin_W;
    // The host's coordinates round, in pose and frames: a float has a grain of 60 um at 1 km.
    const double rounding = 4.0 * SIMD_EPSILON * (joint.pin_W.norm() + 1.0);
    largest = std::max(largest, (place(joint.a) - other_W).norm() - rounding);
  }
  return largest;
}

/// Deepest overlap of the world's bodies at the start [m].
double StressSite::findRigidOverlap() {
  double deepest = 0.0;
  world_.performDiscreteCollisionDetection();
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
    for (int i = 0; i < manifold.getNumContacts(); ++i)
      deepest = std::max(deepest, -static_cast<double>(manifold.getContactPoint(i).getDistance()));
  }
  return deepest;
}

void StressSite::makeDevice() {
  handle_W_ = user_.path.start_W;
  if (user_.is_scripted) {
    device_ = std::make_unique<ScriptedDevice>(user_.path);
    return;
  }
  SimulatedDeviceSettings settings;
  settings.max_force = std::numeric_limits<double>::infinity();
  settings.mass = user_.device_mass;
  settings.damping = user_.device_damping;
  settings.start_W = user_.path.start_W;
  settings.guide = case_.guide;
  if (user_.max_force > 0.0) settings.max_force = user_.max_force;
  auto simulated = std::make_unique<SimulatedDevice>(settings, makeConstantHand(user_.hand_W));
  simulated_ = simulated.get();
  device_ = std::move(simulated);
}

SiteSettings StressSite::makeSettings() const {
  SiteSettings settings;
  settings.self = peerOf(self_);
  settings.peers = kPeers;
  settings.haptic_rate = case_.haptic_rate;
  settings.packet_rate = case_.packet_rate;
  settings.host_step = case_.host_step;
  settings.contact = case_.contact;
  settings.coordination = case_.coordination;
  settings.angular_coordination = case_.angular;
  settings.proxy = {case_.proxy_mass, case_.proxy_damping, case_.radius};
  settings.hip_radius = case_.radius;
  settings.scheme = &watch_;
  settings.tick_source = TickSource::kCaller;
  // Tests the laws without the guards.
  settings.passivity.enabled = false;
  settings.max_slew = std::numeric_limits<double>::infinity();
  settings.max_peer_speed = std::numeric_limits<double>::infinity();
  // The paper's packets come at their rate whatever moves.
  settings.thins_when_idle = case_.kind != StressKind::kPaper;
  settings.guide = case_.guide;
  return settings;
}

void StressSite::connect(const std::vector<Link*>& links) {
  StatePacket start;
  start.object_count = static_cast<std::uint32_t>(site_->objectCount());
  for (std::uint32_t i = 0; i < start.object_count; ++i) start.objects[i] = {i, site_->object(i)};
  std::size_t remote = 0;
  for (std::size_t user = 0; user < case_.users.size(); ++user) {
    if (user == self_) continue;
    const StressPath& path = case_.users[user].path;
    start.sender = peerOf(user);
    start.user = {path.start_W, Vec3::Zero()};
    Link* link = remote < links.size() ? links[remote] : nullptr;
    if (!link) {
      links_.push_back(std::make_unique<ScriptedLink>(path, start, case_.packet_rate));
      link = links_.back().get();
    }
    links_.push_back(std::make_unique<WatchedLink>(
        *link, watch_, remote, start, 1.0 / case_.haptic_rate, remote == 0 ? kMostLooks : 0));
    site_->connect(peerOf(user), *links_.back(), path.start_W);
    ++remote;
  }
}

void StressSite::tick(std::uint64_t tick) {
  const double now = static_cast<double>(tick) / case_.haptic_rate;
  const double end = static_cast<double>(tick + 1) / case_.haptic_rate;
  site_->tick(now);
  if (simulated_) {
    const Vec3& handle_W = simulated_->handle().p_W;
    hand_work_ += std::max(0.0, user_.hand_W.dot(handle_W - handle_W_));
    handle_W_ = handle_W;
  }
  account_->look(end);
  measures_pins_ = measures_pins_ && !spinsWildly();
  while (static_cast<double>(host_steps_ + 1) * case_.host_step <= end + 1e-9) {
    world_.stepSimulation(static_cast<btScalar>(case_.host_step), 0);
    ++host_steps_;
    if (measures_pins_) pin_gap_ = std::max(pin_gap_, measurePins());
    account_->lookAfterHost(end);
  }
}

bool StressSite::isFinite() const {
  bool finite = account_->isFinite() && site_->force().allFinite() &&
                !(site_->status() & (kStateNotFinite | kDeviceInvalid));
  for (int i = 0; finite && i < world_.getNumCollisionObjects(); ++i)
    if (const btRigidBody* body = btRigidBody::upcast(world_.getCollisionObjectArray()[i]))
      finite = tandem::isFinite(stateOf(*body));
  return finite;
}

double StressSite::deviceEnergy() const {
  return simulated_ ? 0.5 * user_.device_mass * simulated_->handle().v_W.squaredNorm() : 0.0;
}

}  // namespace tandem::demos::bench
