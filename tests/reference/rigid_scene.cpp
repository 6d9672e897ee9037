#include "reference/rigid_scene.h"

#include <algorithm>
#include <cmath>

namespace tandem::reference {
namespace {

Vec3 boxPointVelocity(const Box& box, const Vec3& point) {
  return box.v + box.w.cross(point - box.p);
}

}  // namespace

Box makeUniformBox(const Vec3& size, double mass) {
  Box box;
  box.size = size;
  box.mass = mass;
  const Vec3 squares = size.cwiseAbs2();
  box.inertia = mass / 12.0 * (Vec3::Constant(squares.sum()) - squares);
  return box;
}

Contact computeSphereBoxContact(const Sphere& sphere, const Box& box) {
  const Vec3 half = box.size / 2.0;
  const Vec3 centre_B = box.q.conjugate() * (sphere.p - box.p);
  const Vec3 nearest_B = centre_B.cwiseMax(-half).cwiseMin(half);
  const Vec3 outward_B = centre_B - nearest_B;
  const double distance = outward_B.norm();
  if (distance > 0.0) {
    return {sphere.radius - distance, box.q * (outward_B / distance), box.p + box.q * nearest_B};
  }

  Eigen::Index axis = 0;
  const double depth = (half - centre_B.cwiseAbs()).minCoeff(&axis);
  Vec3 normal_B = Vec3::Zero();
  normal_B[axis] = std::copysign(1.0, centre_B[axis]);
  const Vec3 on_face_B = centre_B + depth * normal_B;
  return {sphere.radius + depth, box.q * normal_B, box.p + box.q * on_face_B};
}

Contact computeSphereSphereContact(const Sphere& sphere, const Sphere& other) {
  const Vec3 offset = sphere.p - other.p;
  const double distance = offset.norm();
  Contact contact;
  if (distance > 0.0) contact.normal = offset / distance;
  contact.overlap = sphere.radius + other.radius - distance;
  contact.point = other.p + other.radius * contact.normal;
  return contact;
}

Vec3 computeContactForce(const SpringDamper& gains, const Contact& contact, const Vec3& velocity) {
  if (contact.overlap <= 0.0) return Vec3::Zero();
  const double overlap_rate = -contact.normal.dot(velocity);
  const double force = gains.stiffness * contact.overlap + gains.damping * overlap_rate;
  return std::max(0.0, force) * contact.normal;
}

void findTouches(const RigidScene& scene, std::vector<Touch>& touches) {
  touches.clear();
  for (std::size_t s = 0; s < scene.spheres.size(); ++s) {
    const Sphere& sphere = scene.spheres[s];
    if (!sphere.touches) continue;
    for (std::size_t b = 0; b < scene.boxes.size(); ++b) {
      const Contact contact = computeSphereBoxContact(sphere, scene.boxes[b]);
      if (contact.overlap <= 0.0) continue;
      const Vec3 velocity = sphere.v - boxPointVelocity(scene.boxes[b], contact.point);
      touches.push_back(
          {s, true, b, contact, computeContactForce(scene.contact, contact, velocity)});
    }
    for (std::size_t o = s + 1; o < scene.spheres.size(); ++o) {
      const Sphere& other = scene.spheres[o];
      if (!other.touches) continue;
      const Contact contact = computeSphereSphereContact(sphere, other);
      if (contact.overlap <= 0.0) continue;
      const Vec3 velocity = sphere.v - other.v;
      touches.push_back(
          {s, false, o, contact, computeContactForce(scene.contact, contact, velocity)});
    }
  }
}

Vec3 computeContactForceOnSphere(const RigidScene& scene, std::size_t sphere) {
  std::vector<Touch> touches;
  findTouches(scene, touches);
  Vec3 sum = Vec3::Zero();
  for (const Touch& touch : touches) {
    if (touch.sphere == sphere) sum += touch.force;
    if (!touch.other_is_box && touch.other == sphere) sum -= touch.force;
  }
  return sum;
}

Vec3 computeRotationVector(const Quat& from, const Quat& to) {
  Quat turn = to * from.conjugate();
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();  // sine of half the angle
  if (sine == 0.0) return Vec3::Zero();
  return 2.0 * std::atan2(sine, turn.w()) / sine * turn.vec();
}

Vec3 computeSpin(const Box& box) {
  const Vec3 w_B = box.q.conjugate() * box.w;
  return box.q * box.inertia.cwiseProduct(w_B);
}

double computeEnergy(const RigidScene& scene) {
  const auto springEnergy = [](double stiffness, double stretch) {
    return 0.5 * stiffness * stretch * stretch;
  };
  double energy = 0.0;
  for (const Sphere& sphere : scene.spheres) {
    if (sphere.motion != Motion::kDynamic) continue;
    energy +=
        0.5 * sphere.mass * sphere.v.squaredNorm() - sphere.mass * scene.gravity.dot(sphere.p);
    energy += springEnergy(sphere.coupling.stiffness, (sphere.target_p - sphere.p).norm());
  }
  for (const Box& box : scene.boxes) {
    energy += 0.5 * box.mass * box.v.squaredNorm() + 0.5 * box.w.dot(computeSpin(box)) -
              box.mass * scene.gravity.dot(box.p);
    energy += springEnergy(box.coupling.stiffness, (box.target_p - box.p).norm());
    energy += springEnergy(box.angular_coupling.stiffness,
                           computeRotationVector(box.q, box.target_q).norm());
  }
  std::vector<Touch> touches;
  findTouches(scene, touches);
  for (const Touch& touch : touches) {
    energy += springEnergy(scene.contact.stiffness, touch.contact.overlap);
  }
  return energy;
}

Vec3 computeMomentum(const RigidScene& scene) {
  Vec3 momentum = Vec3::Zero();
  for (const Sphere& sphere : scene.spheres) {
    if (sphere.motion == Motion::kDynamic) momentum += sphere.mass * sphere.v;
  }
  for (const Box& box : scene.boxes) momentum += box.mass * box.v;
  return momentum;
}

Vec3 computeAngularMomentum(const RigidScene& scene) {
  Vec3 momentum = Vec3::Zero();
  for (const Sphere& sphere : scene.spheres) {
    if (sphere.motion == Motion::kDynamic) momentum += sphere.mass * sphere.p.cross(sphere.v);
  }
  for (const Box& box : scene.boxes) momentum += box.mass * box.p.cross(box.v) + computeSpin(box);
  return momentum;
}

}  // namespace tandem::reference
