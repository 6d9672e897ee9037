#include "world/scene.h"

#include <algorithm>

#include <fmt/format.h>

#include "tandem/bullet_bridge/convert.h"
#include "tandem/coordination/scheme.h"

#include "world/scenario_device.h"

namespace tandem::demos {
namespace {

/// `index` counts sites from 0.
PeerId idOf(int index) { return PeerId{static_cast<std::uint32_t>(index) + 1}; }

SiteSettings makeSettings(const Scenario& scenario, int index) {
  const SiteScenario& own = scenario.sites[static_cast<std::size_t>(index)];
  SiteSettings settings = scenario.site;
  settings.self = idOf(index);
  settings.peers = static_cast<int>(scenario.sites.size());
  settings.contact = own.makeContact(settings.contact);
  settings.host_step = 1.0 / scenario.host_rate;
  if (scenario.angular_stiffness >= 0.0)
    settings.angular_coordination =
        CouplerGains{scenario.angular_stiffness, scenario.angular_damping};
  settings.hip_radius = settings.proxy.radius;
  settings.scheme = &findScheme(scenario.scheme);
  settings.tick_source = TickSource::kCaller;
  if (scenario.guide) settings.guide = scenario.axis;
  settings.inner_step = 1.0 / scenario.inner_rate;
  settings.passivity.band = 0.5 * settings.passivity.tank;
  return settings;
}

/// A hand takes hold of an object that is at most this far from it [m].
constexpr double kGripReach = 0.01;

/// From a point in the shape's frame to the shape's bounds [m].
double computeDistance(const btCollisionShape& shape, const Vec3& p_B) {
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  const Vec3 nearest = p_B.cwiseMax(fromBullet(low)).cwiseMin(fromBullet(high));
  return (p_B - nearest).norm();
}

}  // namespace

SiteWorld::SiteWorld(const Scenario& scenario, int index, const PeerLinks& links,
                     const BodyPlaces& places)
    : scene_(scenario, places),
      host_rate_(scenario.host_rate),
      simulated_(makeScenarioDevice(scenario, scene_.frame(), index)) {
  build(scenario, index, links, *simulated_);
}

SiteWorld::SiteWorld(const Scenario& scenario, int index, const PeerLinks& links,
                     HapticDevice& device, const BodyPlaces& places)
    : scene_(scenario, places), host_rate_(scenario.host_rate) {
  build(scenario, index, links, device);
}

void SiteWorld::build(const Scenario& scenario, int index, const PeerLinks& links,
                      HapticDevice& device) {
  SceneBody handle;
  handle.name = "device";
  handle.role = "device";
  handle.radius = scenario.site.proxy.radius;
  scene_bodies_.push_back(handle);
  for (const PlacedBody& placed : scene_.bodies()) scene_bodies_.push_back(describeBody(placed));

  site_ = std::make_unique<Site>(makeSettings(scenario, index), world(), device);
  for (const PlacedBody& placed : scene_.bodies())
    if (placed.plan.body.shared) share(placed);
  hand_radius_ = scenario.site.proxy.radius;
  may_grip_ = scenario.mayGrip();
  grips_ = scenario.sites[static_cast<std::size_t>(index)].hand.grips;
  connect(scenario, index, links);
}

/// Connects all other users in the order of their numbers.
void SiteWorld::connect(const Scenario& scenario, int index, const PeerLinks& links) {
  for (int other = 0; other < static_cast<int>(scenario.sites.size()); ++other)
    if (other != index)
      site_->connect(idOf(other), links.to(other, index),
                     computeStart(scenario, scene_.frame(), other));
  for (int remote = 0; remote < site_->remoteCount(); ++remote) {
    const btRigidBody* proxy = site_->proxyBody(remote);
    if (!proxy) continue;
    SceneBody body;
    body.name = remote == 0 ? "proxy" : fmt::format("proxy{}", remote + 1);
    body.role = "proxy";
    body.body = proxy;
    body.radius = scenario.site.proxy.radius;
    scene_bodies_.push_back(body);
  }
}

SiteWorld::~SiteWorld() = default;

BodyPlaces SiteWorld::places() const {
  BodyPlaces places;
  for (const SceneBody& body : scene_bodies_)
    if (body.role == "object" || body.role == "neighbour") places[body.name] = pose(body);
  return places;
}

RigidState SiteWorld::pose(const SceneBody& body) const {
  RigidState state;
  if (!body.body) {
    state.p_W = simulated_ ? simulated_->handle().p_W : site_->hip().p_W;
    return state;
  }
  state.p_W = fromBullet(body.body->getCenterOfMassPosition());
  state.q_WB = fromBullet(body.body->getOrientation());
  return state;
}

void SiteWorld::stepHostUntil(double now) {
  // Times are counted, not summed; the slack covers their rounding.
  while (static_cast<double>(host_steps_ + 1) / host_rate_ <= now + 1e-9) {
    world().stepSimulation(static_cast<btScalar>(1.0 / host_rate_), 0);
    ++host_steps_;
    if (!grips_.empty()) holdOrRelease(isGripTime(static_cast<double>(host_steps_) / host_rate_));
  }
}

bool SiteWorld::isGripTime(double time) const noexcept {
  return std::any_of(grips_.begin(), grips_.end(), [&](const std::array<double, 2>& grip) {
    return time >= grip[0] && time < grip[1];
  });
}

void SiteWorld::hold(bool wants) {
  grips_.clear();
  holdOrRelease(wants);
}

void SiteWorld::holdOrRelease(bool wants) {
  if (!wants && holds_) site_->release();
  if (!wants) holds_ = false;
  if (!wants || holds_ || !may_grip_) return;
  std::optional<ObjectId> reached;
  site_->betweenTicks([&] { reached = findInReach(); });
  if (!reached) return;
  site_->grab(*reached);
  holds_ = true;
}

/// The object whose bounds are nearest to the hand, if they are within reach.
std::optional<ObjectId> SiteWorld::findInReach() const {
  std::optional<ObjectId> nearest;
  double least = hand_radius_ + kGripReach;
  for (const ObjectId id : grippable_) {
    const RigidState& state = site_->object(id);
    const Vec3 hand_B = state.q_WB.conjugate() * (site_->hip().p_W - state.p_W);
    const double distance = computeDistance(*site_->objectBody(id).getCollisionShape(), hand_B);
    if (distance > least) continue;
    least = distance;
    nearest = id;
  }
  return nearest;
}

void SiteWorld::share(const PlacedBody& placed) {
  const BodyScenario& body = placed.plan.body;
  if (body.tool_of != 0)
    site_->shareTool(*placed.body, PeerId{static_cast<std::uint32_t>(body.tool_of)});
  else
    grippable_.push_back(site_->share(*placed.body, body.damping));
}

}  // namespace tandem::demos
