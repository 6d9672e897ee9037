#include "stability/drawn/pressed_sites.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "demos/program/analyse/loop_of_scenario.h"
#include "demos/program/world/scene_frame.h"

namespace tandem::test {
namespace {

const HandImpedance kAcross{0.0, 300.0, 5.0};

constexpr double kDepth = 1e-3, kDeepest = 1e-2;  // of a hand in the cube, about [m]
constexpr double kLeastSpeed = 0.02;  // of a hand that leaves and does not open contact [m/s]
constexpr double kLightly = 0.1;  // part of the force, where nothing keeps the cube from turning

/// Force of a user towards the others. Those of both sides add up to 0.
double computePush(const LoopSettings& settings, int site, Keeping keeping) {
  const CouplerGains& contact = settings.contact;
  const double depth =
      std::clamp(kLeastSpeed * contact.damping / contact.stiffness, kDepth, kDeepest);
  const double part = keeping == Keeping::kNothing ? kLightly : 1.0;
  const double push = part * depth * (contact.stiffness + 2.0 * settings.hand.stiffness);
  if (site % 2 == 0) return push;
  const int right = settings.users / 2;
  return -push * (settings.users - right) / right;
}

/// Gives each site what differs from all.
void tellSites(const LoopSettings& settings, demos::Scenario& s) {
  for (std::size_t i = 0; i < settings.each.size(); ++i) {
    const LoopUser& user = settings.each[i];
    s.sites[i].device_mass = user.device_mass * settings.device_mass + settings.hand.mass;
    s.sites[i].device_damping = user.device_damping * settings.device_damping;
    s.sites[i].contact_stiffness = user.contact_stiffness * settings.contact.stiffness;
    s.sites[i].contact_damping = user.contact_damping * settings.contact.damping;
    std::vector<double>& row = s.delays.emplace_back(settings.each.size(), settings.delay);
    for (std::size_t k = 0; k < user.delays.size(); ++k) row[k] *= user.delays[k];
  }
}

demos::Scenario makeScenario(const LoopSettings& settings, Keeping keeping) {
  demos::Scenario s;
  s.kind = settings.has_object ? "cooperative_manipulation" : "user_contact";
  s.scheme = demos::schemeOf(settings.stand_in);
  s.guide = keeping == Keeping::kGuide;
  s.sites.resize(static_cast<std::size_t>(settings.users));
  s.site.coordination_mode = settings.mode;
  s.site.contact = settings.contact;
  s.site.coordination = settings.coordination;
  s.object_mass = settings.object_mass;
  s.object_damping = settings.object_damping;
  // Contacts are far from the cube's middle, and hands from each other or, if it may turn, near.
  const bool may_turn = keeping == Keeping::kNothing;
  s.object_size = may_turn ? 0.1 : 0.2;
  s.site.proxy.radius = may_turn ? 0.004 : 0.03;
  s.site.proxy.mass = settings.proxy_mass;
  s.site.proxy.damping = settings.proxy_damping;
  s.device.mass = settings.device_mass + settings.hand.mass;
  s.device.damping = settings.device_damping;
  s.site.haptic_rate = settings.haptic_rate;
  s.site.packet_rate = settings.packet_rate;
  s.network.delay = settings.delay;
  s.site.thins_when_idle = false;
  s.site.passivity.enabled = false;
  s.site.link_loss.enabled = false;
  s.site.max_slew = std::numeric_limits<double>::infinity();
  tellSites(settings, s);
  return s;
}

void keepOnLine(btRigidBody& cube) {
  cube.setLinearFactor(btVector3(1, 0, 0));
  cube.setAngularFactor(0);
}

}  // namespace

PressedSites::PressedSites(const LoopSettings& settings, const HandImpedance& calm, Keeping keeping)
    : scenario_(makeScenario(settings, keeping)), links_(scenario_) {
  for (int i = 0; i < settings.users; ++i) {
    const SimulatedDeviceSettings device = makeDevice(i);
    auto hand = std::make_unique<PressingHand>(computePush(settings, i, keeping), device.start_W,
                                               settings.hand, calm, kAcross);
    hands_.push_back(hand.get());
    devices_.push_back(std::make_unique<SimulatedDevice>(device, std::move(hand)));
    worlds_.push_back(
        std::make_unique<demos::SiteWorld>(scenario_, i, links_.of(i), *devices_.back()));
    if (keeping == Keeping::kFactors) keepOnLine(worlds_.back()->site().objectBody(0));
  }
}

SimulatedDeviceSettings PressedSites::makeDevice(int site) const {
  SimulatedDeviceSettings device;
  const demos::DeviceScenario own =
      scenario_.sites[static_cast<std::size_t>(site)].makeDevice(scenario_.device);
  device.mass = own.mass;
  device.damping = own.damping;
  device.start_W = demos::computeStart(scenario_, demos::makeSceneFrame(scenario_), site);
  if (scenario_.guide) device.guide = Vec3::UnitX();
  device.max_force = std::numeric_limits<double>::infinity();
  return device;
}

void PressedSites::tick() {
  const double now = this->now();
  for (auto& world : worlds_) world->site().tick(now);
  for (PressingHand* hand : hands_) hand->nudge = 0.0;
  ++ticks_;
  for (auto& world : worlds_) world->stepHostUntil(this->now());
}

void PressedSites::letGo() {
  for (std::size_t i = 0; i < hands_.size(); ++i) hands_[i]->letGo(devices_[i]->handle());
}

void PressedSites::nudge(const Eigen::VectorXd& impulses) {
  for (std::size_t i = 0; i < hands_.size(); ++i)
    hands_[i]->nudge = impulses(static_cast<Eigen::Index>(i)) * scenario_.site.haptic_rate;
}

void PressedSites::pull(double force) {
  for (PressingHand* hand : hands_) hand->pull = force;
}

Eigen::VectorXd PressedSites::velocities() {
  const auto count = static_cast<Eigen::Index>(worlds_.size());
  const bool has_object = scenario_.hasObject();
  Eigen::VectorXd all(has_object ? 2 * count : count);
  for (Eigen::Index i = 0; i < count; ++i) {
    Site& site = worlds_[static_cast<std::size_t>(i)]->site();
    all(i) = site.hip().v_W.x();
    if (has_object) all(count + i) = site.object(0).v_W.x();
  }
  return all;
}

double PressedSites::findLeastDepth() {
  double least = std::numeric_limits<double>::infinity();
  for (auto& world : worlds_) least = std::min(least, findLeastDepth(world->site()));
  return least;
}

double PressedSites::findLeastDepth(Site& site) const {
  const double radius = scenario_.site.proxy.radius;
  const bool has_object = scenario_.hasObject();
  const double reach = radius + (has_object ? 0.5 * scenario_.object_size : radius);
  const RigidState& middle = has_object ? site.object(0) : site.hip();
  const double lead = scenario_.site.contact.damping / scenario_.site.contact.stiffness;
  const double side = site.hip().p_W.x() < 0.0 ? -1.0 : 1.0;
  double least = side * site.force().x() / scenario_.site.contact.stiffness;
  // Contact never pulls: it opens where its damper takes away what its spring gives.
  const auto add = [&](const RigidState& user) {
    const Vec3 way_W = user.p_W - middle.p_W;
    const Vec3 v_W = user.v_W - middle.v_W - middle.w_W.cross(way_W);
    const Quat q_BW = has_object ? middle.q_WB.conjugate() : Quat::Identity();
    const double way = (q_BW * way_W).x();
    const double leaving = (q_BW * v_W).x() * (way < 0.0 ? -1.0 : 1.0);
    least = std::min(least, reach - std::abs(way) - lead * leaving);
  };
  if (has_object) add(site.hip());
  for (int remote = 0; remote < site.remoteCount(); ++remote)
    if (const RigidState* proxy = site.proxy(remote)) add(*proxy);
  return least;
}

}  // namespace tandem::test
