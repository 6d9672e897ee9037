#include "world/scene.h"

#include <algorithm>
#include <limits>

#include "tandem/bullet_bridge/convert.h"
#include "tandem/coordination/scheme.h"

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr double kFloorHalfThickness = 0.05;  // [m]
constexpr double kFloorHalfWidth = 1.0;       // [m]

/// A hand whose forces are given in the scene's frame.
class SceneHand final : public Hand {
 public:
  SceneHand(std::unique_ptr<Hand> hand, const SceneFrame& frame)
      : hand_(std::move(hand)), frame_(frame) {}
  Vec3 computeForce(double t, const PointState& handle) const noexcept override {
    const PointState handle_S{frame_.toScene(handle.p_W), frame_.toScene(handle.v_W)};
    return frame_.toWorld(hand_->computeForce(t, handle_S));
  }

 private:
  std::unique_ptr<Hand> hand_;
  SceneFrame frame_;
};

std::unique_ptr<Hand> makeHand(const Scenario& scenario, const SceneFrame& frame, int site) {
  const HandScenario& hand = scenario.hands[static_cast<std::size_t>(site)];
  if (hand.kind == "sine") return makeSineHand(frame.toWorld(hand.force), hand.frequency, 0.0);
  if (hand.kind == "csv") {
    try {
      const std::filesystem::path path = scenario.file.parent_path() / hand.file;
      return std::make_unique<SceneHand>(makeRecordedHand(path.string()), frame);
    } catch (const Error& error) {
      throw UsageError(scenario.file.string() + ": site" + std::to_string(site + 1) +
                       ".hand_file = " + hand.file + ": " + error.what());
    }
  }
  if (hand.kind == "minimum_jerk") {
    const Vec3 start_W = computeStart(scenario, frame, site);
    std::vector<Waypoint> waypoints;
    for (const auto& [t, x, y, z] : hand.waypoints)
      waypoints.push_back({t, start_W + frame.toWorld(Vec3(x, y, z))});
    return makeMinimumJerkHand(std::move(waypoints), hand.stiffness, hand.damping);
  }
  return makeConstantHand(frame.toWorld(hand.force));
}

std::unique_ptr<SimulatedDevice> makeDevice(const Scenario& scenario, const SceneFrame& frame,
                                            int site) {
  SimulatedDeviceSettings settings;
  settings.mass = scenario.device_mass;
  settings.damping = scenario.device_damping;
  settings.start_W = computeStart(scenario, frame, site);
  if (scenario.guide) settings.guide = scenario.axis;
  settings.encoder_resolution = scenario.encoder_resolution;
  const double max_force = scenario.device_max_force;
  settings.max_force = max_force > 0.0 ? max_force : std::numeric_limits<double>::infinity();
  return std::make_unique<SimulatedDevice>(settings, makeHand(scenario, frame, site));
}

SiteSettings makeSettings(const Scenario& scenario, int index) {
  SiteSettings settings = scenario.site;
  settings.self = PeerId{static_cast<std::uint32_t>(index) + 1};
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

}  // namespace

SceneFrame makeSceneFrame(const Scenario& scenario) {
  const Vec3 x = Vec3::UnitX();
  if (scenario.axis == x) return {};
  // Opposite to x there is no unique shortest turn: turns about z, so that up stays up.
  if (scenario.axis == -x) return {Quat(0.0, 0.0, 0.0, 1.0)};
  return {Quat::FromTwoVectors(x, scenario.axis)};
}

Vec3 computeStart(const Scenario& scenario, const SceneFrame& frame, int site) {
  const double side = site == 0 ? -1.0 : 1.0;
  const double distance =
      scenario.site.proxy.radius + (scenario.hasObject() ? 0.5 * scenario.object_size : 0.0);
  return frame.toWorld(side * distance * Vec3::UnitX() +
                       scenario.hands[static_cast<std::size_t>(site)].start_offset);
}

SiteWorld::SiteWorld(const Scenario& scenario, int index, Link& link, const BodyPlaces& places)
    : frame_(makeSceneFrame(scenario)),
      places_(places),
      friction_(scenario.friction),
      host_rate_(scenario.host_rate),
      simulated_(makeDevice(scenario, frame_, index)) {
  build(scenario, index, link, *simulated_);
}

SiteWorld::SiteWorld(const Scenario& scenario, int index, Link& link, HapticDevice& device,
                     const BodyPlaces& places)
    : frame_(makeSceneFrame(scenario)),
      places_(places),
      friction_(scenario.friction),
      host_rate_(scenario.host_rate) {
  build(scenario, index, link, device);
}

void SiteWorld::build(const Scenario& scenario, int index, Link& link, HapticDevice& device) {
  world_.setGravity(toBullet(frame_.toWorld(-scenario.gravity * Vec3::UnitZ())));
  SceneBody handle;
  handle.name = "device";
  handle.role = "device";
  handle.radius = scenario.site.proxy.radius;
  scene_bodies_.push_back(handle);

  addObstacles(scenario);
  btRigidBody* object = nullptr;
  if (scenario.hasObject())
    object = &addBox(Vec3::Constant(0.5 * scenario.object_size), scenario.object_mass, Vec3::Zero(),
                     "cube", "object");

  site_ = std::make_unique<Site>(makeSettings(scenario, index), world_, device);
  if (object) site_->share(*object, scenario.object_damping);
  hand_radius_ = scenario.site.proxy.radius;
  if (object && scenario.mayGrip()) object_size_ = scenario.object_size;
  grips_ = scenario.hands[static_cast<std::size_t>(index)].grips;
  site_->connect(PeerId{index == 0 ? 2u : 1u}, link, computeStart(scenario, frame_, 1 - index));

  if (const btRigidBody* proxy = site_->proxyBody(0)) {
    SceneBody body;
    body.name = "proxy";
    body.role = "proxy";
    body.body = proxy;
    body.radius = scenario.site.proxy.radius;
    scene_bodies_.push_back(body);
  }
}

SiteWorld::~SiteWorld() {
  site_.reset();
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
}

BodyPlaces SiteWorld::places() const {
  BodyPlaces places;
  for (const SceneBody& body : scene_bodies_)
    if (body.is_box && !body.is_static) places[body.name] = pose(body);
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
    world_.stepSimulation(static_cast<btScalar>(1.0 / host_rate_), 0);
    ++host_steps_;
    if (!grips_.empty()) hold(isGripTime(static_cast<double>(host_steps_) / host_rate_));
  }
}

bool SiteWorld::isGripTime(double time) const noexcept {
  return std::any_of(grips_.begin(), grips_.end(), [&](const std::array<double, 2>& grip) {
    return time >= grip[0] && time < grip[1];
  });
}

void SiteWorld::hold(bool wants) {
  if (!wants && holds_) site_->release();
  if (!wants) holds_ = false;
  if (!wants || holds_ || object_size_ == 0.0) return;
  bool touches = false;
  site_->betweenTicks([&] {
    const RigidState& cube = site_->object(0);
    const Vec3 hand_B = cube.q_WB.conjugate() * (site_->hip().p_W - cube.p_W);
    touches = hand_B.cwiseAbs().maxCoeff() <= 0.5 * object_size_ + hand_radius_ + kGripReach;
  });
  if (!touches) return;
  site_->grab(0);
  holds_ = true;
}

btRigidBody& SiteWorld::addBox(const Vec3& half_extents, double mass, const Vec3& p_S,
                               const std::string& name, const std::string& role) {
  shapes_.push_back(std::make_unique<btBoxShape>(toBullet(half_extents)));
  btVector3 inertia(0, 0, 0);
  if (mass > 0.0) shapes_.back()->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr,
                                                shapes_.back().get(), inertia);
  info.m_friction = static_cast<btScalar>(friction_);
  RigidState start;
  start.p_W = frame_.toWorld(p_S);
  start.q_WB = frame_.q_WS;
  if (const auto place = places_.find(name); place != places_.end()) start = place->second;
  info.m_startWorldTransform = btTransform(toBullet(start.q_WB), toBullet(start.p_W));
  bodies_.push_back(std::make_unique<btRigidBody>(info));
  world_.addRigidBody(bodies_.back().get());

  SceneBody body;
  body.name = name;
  body.role = role;
  body.body = bodies_.back().get();
  body.is_box = true;
  body.half_extents = half_extents;
  body.is_static = mass == 0.0;
  scene_bodies_.push_back(body);
  return *bodies_.back();
}

void SiteWorld::addObstacles(const Scenario& scenario) {
  if (scenario.floor) {
    const double height = -0.5 * scenario.object_size - kFloorHalfThickness;
    addBox(Vec3(kFloorHalfWidth, kFloorHalfWidth, kFloorHalfThickness), 0.0, Vec3(0, 0, height),
           "floor", "obstacle");
  }
  int number = 0;
  for (const NeighbourBox& box : scenario.boxes)
    addBox(Vec3::Constant(0.5 * box.size), box.mass, box.position, "box" + std::to_string(++number),
           box.mass > 0.0 ? "neighbour" : "obstacle");
}

}  // namespace tandem::demos
