#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "bench/reference/spring_damper.h"

namespace tandem::reference {

using Vec3 = Eigen::Vector3d;
using Quat = Eigen::Quaterniond;

/// Motion of a sphere.
enum class Motion {
  kDynamic,     ///< moved by all forces, including contacts
  kDriven,      ///< moved by its own forces and coupling only: contacts push the others but not it
  kPrescribed,  ///< moved by p + v tau from its start, without forces
};

/// A sphere that does not rotate: a point mass with a radius. World frame W.
struct Sphere {
  double radius = 0.01;  ///< [m]
  double mass = 0.1;     ///< [kg]
  double damping = 0.0;  ///< linear, relative to the world [N s/m]
  Motion motion = Motion::kDynamic;
  bool touches = true;  ///< takes part in contacts

  Vec3 p = Vec3::Zero();      ///< centre [m]
  Vec3 v = Vec3::Zero();      ///< [m/s]
  Vec3 force = Vec3::Zero();  ///< constant external force [N]

  SpringDamper coupling{};       ///< towards the held target below
  Vec3 target_p = Vec3::Zero();  ///< [m]
  Vec3 target_v = Vec3::Zero();  ///< [m/s]
};

/// A box that moves freely in space. World frame W.
struct Box {
  Vec3 size = Vec3::Constant(0.04);  ///< edge lengths along the box's own axes [m]
  double mass = 0.2;                 ///< [kg]
  Vec3 inertia = Vec3::Ones();       ///< principal moments about the centre [kg m^2]
  double damping = 0.0;              ///< linear, of the translation, relative to the world [N s/m]

  Vec3 p = Vec3::Zero();       ///< centre [m]
  Quat q = Quat::Identity();   ///< turns box coordinates into world coordinates
  Vec3 v = Vec3::Zero();       ///< velocity of the centre [m/s]
  Vec3 w = Vec3::Zero();       ///< angular velocity in W [rad/s]
  Vec3 force = Vec3::Zero();   ///< constant external force at the centre [N]
  Vec3 torque = Vec3::Zero();  ///< constant external torque in W [N m]

  SpringDamper coupling{};           ///< towards target_p, target_v
  SpringDamper angular_coupling{};   ///< towards target_q, target_w
  Vec3 target_p = Vec3::Zero();      ///< [m]
  Vec3 target_v = Vec3::Zero();      ///< [m/s]
  Quat target_q = Quat::Identity();  ///< orientation
  Vec3 target_w = Vec3::Zero();      ///< [rad/s]
};

/// A uniform box at rest at the origin: inertia m/12 (b^2 + c^2) about each axis.
[[nodiscard]] Box makeUniformBox(const Vec3& size, double mass);

/// Bodies with frictionless contacts: every sphere with every box and every other sphere. Boxes do
/// not touch each other.
struct RigidScene {
  SpringDamper contact{};       ///< gains of every contact
  Vec3 gravity = Vec3::Zero();  ///< acts on all but prescribed bodies [m/s^2]
  std::vector<Sphere> spheres{};
  std::vector<Box> boxes{};
};

/// Contact of a sphere with another body.
struct Contact {
  double overlap = 0.0;         ///< positive while they overlap [m]
  Vec3 normal = Vec3::UnitX();  ///< points from the other body towards the sphere
  Vec3 point = Vec3::Zero();  ///< point of the other body's surface nearest to the sphere's centre
};

/// Nearest point of a box, on a face, an edge or a corner. For a centre inside the box it is the
/// nearest point of the nearest face, and the overlap grows with the depth.
[[nodiscard]] Contact computeSphereBoxContact(const Sphere& sphere, const Box& box);

/// Contact of `sphere` with `other`, along the line between their centres.
[[nodiscard]] Contact computeSphereSphereContact(const Sphere& sphere, const Sphere& other);

/// Force on the sphere [N]: [K overlap + B d(overlap)/dt]+ along the normal while they overlap.
/// `velocity` is the sphere's, relative to the other body's material at the contact point [m/s].
[[nodiscard]] Vec3 computeContactForce(const SpringDamper& gains, const Contact& contact,
                                       const Vec3& velocity);

/// A sphere that overlaps a box or another sphere, and the contact force on the sphere.
struct Touch {
  std::size_t sphere = 0;     ///< index in RigidScene::spheres
  bool other_is_box = false;  ///< the other body is a box, else a sphere
  std::size_t other = 0;      ///< index of the other body among its kind
  Contact contact{};
  Vec3 force = Vec3::Zero();  ///< force on the sphere [N]; its opposite acts at contact.point
};

/// Replaces `touches` by all pairs that overlap now, each pair once.
void findTouches(const RigidScene& scene, std::vector<Touch>& touches);

/// Sum of the contact forces on one sphere, for any kind of its motion [N].
[[nodiscard]] Vec3 computeContactForceOnSphere(const RigidScene& scene, std::size_t sphere);

/// Axis times angle of the shortest rotation from `from` to `to`, in W [rad].
[[nodiscard]] Vec3 computeRotationVector(const Quat& from, const Quat& to);

/// Angular momentum of a box about its centre, in W: inertia times angular velocity [kg m^2/s].
[[nodiscard]] Vec3 computeSpin(const Box& box);

/// Kinetic energy of the dynamic bodies, energy in contact and coupling springs, and -m g p [J].
[[nodiscard]] double computeEnergy(const RigidScene& scene);

/// Momentum of the dynamic bodies [kg m/s].
[[nodiscard]] Vec3 computeMomentum(const RigidScene& scene);

/// Angular momentum of the dynamic bodies about the world's origin [kg m^2/s].
[[nodiscard]] Vec3 computeAngularMomentum(const RigidScene& scene);

}  // namespace tandem::reference
