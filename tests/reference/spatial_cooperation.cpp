#include "reference/spatial_cooperation.h"

#include <cstddef>
#include <deque>

#include "reference/rigid_reference.h"

namespace tandem::reference {
namespace {

// Spheres of a site's scene. The device is a driven body: it feels its hand and the held force, not
// the contacts of the island. The HIP's motion decides whether device or HIP touches.
enum SphereIndex : std::size_t { kDevice, kHip, kProxy, kSphereCount };

// State that one site sends to the other.
struct Packet {
  Vec3 device_p, device_v;
  Vec3 box_p, box_v;
  Quat box_q;
  Vec3 box_w;
};

class SpatialUser {
 public:
  SpatialUser(const SpatialParameters& parameters, std::size_t self);

  [[nodiscard]] Packet packet() const;
  void hold(const Packet& packet);
  void sample();
  void advance(double duration) { advanceScene(scene_, duration, step_); }
  [[nodiscard]] SpatialSite report() const;

 private:
  [[nodiscard]] const Sphere& device() const { return scene_.spheres[kDevice]; }
  [[nodiscard]] const Box& box() const { return scene_.boxes.front(); }

  RigidScene scene_;
  std::size_t touching_;  // the sphere that represents the local user in contacts
  double step_;
  Vec3 hand_force_;
  Vec3 held_force_ = Vec3::Zero();
};

SpatialUser::SpatialUser(const SpatialParameters& parameters, std::size_t self)
    : touching_(parameters.hip_motion == HipMotion::kContinuous ? kDevice : kHip),
      step_(parameters.step),
      hand_force_(parameters.hand_force[self]) {
  scene_.contact = parameters.contact;

  Sphere sphere;
  sphere.radius = parameters.proxy_radius;
  sphere.mass = parameters.proxy_mass;
  scene_.spheres.assign(kSphereCount, sphere);

  Sphere& own_device = scene_.spheres[kDevice];
  own_device.motion = Motion::kDriven;
  own_device.damping = parameters.device_damping;
  own_device.p = computeStart(parameters, self);

  Sphere& hip = scene_.spheres[kHip];
  hip.motion = Motion::kPrescribed;
  hip.p = own_device.p;

  own_device.touches = touching_ == kDevice;
  hip.touches = touching_ == kHip;

  Sphere& proxy = scene_.spheres[kProxy];
  proxy.damping = parameters.proxy_damping;
  proxy.p = computeStart(parameters, 1 - self);
  proxy.coupling = parameters.coordination;
  proxy.target_p = proxy.p;

  Box copy = makeUniformBox(Vec3::Constant(parameters.object_size), parameters.object_mass / 2.0);
  copy.damping = parameters.object_damping;
  copy.coupling = parameters.coordination;
  copy.angular_coupling = computeAngularCoordination(parameters);
  scene_.boxes.push_back(copy);
}

Packet SpatialUser::packet() const {
  return {device().p, device().v, box().p, box().v, box().q, box().w};
}

void SpatialUser::hold(const Packet& packet) {
  Sphere& proxy = scene_.spheres[kProxy];
  proxy.target_p = packet.device_p;
  proxy.target_v = packet.device_v;
  Box& copy = scene_.boxes.front();
  copy.target_p = packet.box_p;
  copy.target_v = packet.box_v;
  copy.target_q = packet.box_q;
  copy.target_w = packet.box_w;
}

void SpatialUser::sample() {
  scene_.spheres[kHip].p = device().p;
  scene_.spheres[kHip].v = device().v;
  held_force_ = computeContactForceOnSphere(scene_, touching_);
  scene_.spheres[kDevice].force = hand_force_ + held_force_;
}

SpatialSite SpatialUser::report() const {
  return {device().p, device().v, box().p, box().q, scene_.spheres[kProxy].p, held_force_};
}

}  // namespace

Vec3 computeStart(const SpatialParameters& parameters, std::size_t user) {
  const double distance = parameters.object_size / 2.0 + parameters.proxy_radius;
  return (user == 0 ? -distance : distance) * Vec3::UnitX() + parameters.start_offset[user];
}

SpringDamper computeAngularCoordination(const SpatialParameters& parameters) {
  if (parameters.angular_coordination) return *parameters.angular_coordination;
  const double inertia_over_mass = parameters.object_size * parameters.object_size / 6.0;
  return {parameters.coordination.stiffness * inertia_over_mass,
          parameters.coordination.damping * inertia_over_mass};
}

SpatialResult runSpatialCooperation(const SpatialParameters& parameters) {
  SampleClock clock(parameters.sampling);
  std::array<SpatialUser, 2> users{SpatialUser(parameters, 0), SpatialUser(parameters, 1)};
  std::deque<std::array<Packet, 2>> under_way;
  const auto report = [&](double t) {
    return SpatialRow{t, {users[0].report(), users[1].report()}};
  };

  SpatialResult result;
  double t = 0.0;
  for (Instant now = clock.next();; now = clock.next()) {
    for (SpatialUser& user : users) user.advance(now.t - t);
    t = now.t;
    if (now.ends) break;
    if (now.sends) under_way.push_back({users[0].packet(), users[1].packet()});
    if (now.receives) {
      users[0].hold(under_way.front()[1]);
      users[1].hold(under_way.front()[0]);
      under_way.pop_front();
    }
    if (now.ticks) {
      for (SpatialUser& user : users) user.sample();
      result.rows.push_back(report(t));
    }
  }
  result.end = report(t);
  return result;
}

}  // namespace tandem::reference
