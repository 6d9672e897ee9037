#include "island/rest.h"

#include <cmath>

#include "fnv.h"

namespace tandem {
namespace {

// A body at rest moves at most kToGo further, far below what a hand or a picture shows.
constexpr double kSlow = 1e-9;    // [m/s, rad/s]
constexpr double kSteady = 1e-6;  // [m/s^2, rad/s^2]
constexpr double kToGo = 5e-13;   // distance left to the rest position [m]

// A body without a spring must not drift for hours: it may move only by rounding.
constexpr double kStill = 1e-15;          // [m/s, rad/s]
constexpr double kUnaccelerated = 1e-14;  // [m/s^2, rad/s^2]

/// One translational or rotational degree of freedom of a body.
struct Freedom {
  double inertia, stiffness, damping, force, speed;
};

/// Upper bound of the distance that the body may still move; infinite for a body without a spring
/// that does not stand still.
double computeWayLeft(const Freedom& m) noexcept {
  if (m.stiffness > 0.0)
    return (m.force + m.damping * m.speed) / m.stiffness +
           m.speed * std::sqrt(m.inertia / m.stiffness);
  const bool stands = m.speed <= kStill && m.force <= kUnaccelerated * m.inertia;
  return stands ? 0.0 : HUGE_VAL;
}

/// A hash of shapes and places.
class Hash {
 public:
  void add(double value) noexcept { fnv_.addWord(value); }
  void add(Axis axis) noexcept { add(static_cast<double>(axis)); }
  /// The address identifies shared data, which never changes.
  void add(const void* address) noexcept {
    fnv_.addWord(std::uint64_t{reinterpret_cast<std::uintptr_t>(address)});
  }
  void add(const Vec3& v) noexcept { add(v.x()), add(v.y()), add(v.z()); }
  void add(const Sphere& s) noexcept { add(s.radius); }
  void add(const Box& b) noexcept { add(b.half_extents); }
  void add(const Capsule& c) noexcept { add(c.radius), add(c.half_length), add(c.axis); }
  void add(const Cylinder& c) noexcept { add(c.radius), add(c.half_length), add(c.axis); }
  void add(const Cone& c) noexcept {
    add(c.radius), add(c.half_length), add(c.axis), add(c.rounding);
  }
  void add(const ConvexHull& h) noexcept { add(h.solid.get()), add(h.rounding); }
  void add(const Mesh& m) noexcept { add(m.surface.get()), add(m.skin); }
  void add(const Compound& c) noexcept { add(c.parts.get()); }
  void add(const Plane& p) noexcept { add(p.normal_B), add(p.offset); }
  [[nodiscard]] std::uint64_t value() const noexcept { return fnv_.value(); }

 private:
  Fnv fnv_;
};

}  // namespace

bool seemsAtRest(const ModelBody& before, const RigidState& after, double dt) noexcept {
  if (!before.is_active || before.is_ghost || before.settings.motion == Motion::kHeld) return true;
  if (before.settings.motion == Motion::kPrescribed)
    return after.v_W == Vec3::Zero() && after.w_W == Vec3::Zero();
  const auto is_below = [](const Vec3& v, double limit) { return v.squaredNorm() < limit * limit; };
  return is_below(after.v_W, kSlow) && is_below(after.v_W - before.state.v_W, kSteady * dt) &&
         is_below(after.w_W, kSlow) && is_below(after.w_W - before.state.w_W, kSteady * dt);
}

bool isSettled(const IslandModel& model, BodyIndex b, const Wrench& wrench) noexcept {
  const ModelBody& body = model.bodies[b];
  if (!body.isDynamic()) return true;
  const MassFactors& factors = body.factors;
  Freedom way{body.settings.mass / factors.linear, 0.0, body.damping(),
              factors.feltForce(wrench.f_W).norm(), body.state.v_W.norm()};
  const double inertia = body.settings.inertia_B.maxCoeff() / factors.angular;
  Freedom turn{inertia, 0.0, body.settings.angular_damping * inertia,
               factors.feltTorque(wrench.t_W).norm(), body.state.w_W.norm()};
  for (const int c : model.present_couplers) {
    const ModelCoupler& coupler = model.couplers[c];
    if (coupler.follower != b) continue;
    way.stiffness += coupler.now.linear.stiffness;
    way.damping += coupler.now.linear.damping;
    turn.stiffness += coupler.now.angular.stiffness;
    turn.damping += coupler.now.angular.damping;
  }
  if (way.force >= kSteady * way.inertia || !(computeWayLeft(way) < kToGo)) return false;
  if (!body.rotates()) return true;
  return turn.force < kSteady * turn.inertia && computeWayLeft(turn) * body.bounding_radius < kToGo;
}

std::uint64_t computeHash(const std::vector<Obstacle>* obstacles) noexcept {
  Hash hash;
  if (!obstacles) return hash.value();
  for (const Obstacle& obstacle : *obstacles) {
    hash.add(static_cast<double>(obstacle.shape.index()));
    std::visit([&](const auto& shape) { hash.add(shape); }, obstacle.shape);
    hash.add(obstacle.p_WB);
    hash.add(obstacle.q_WB.w());
    hash.add(Vec3(obstacle.q_WB.vec()));
    hash.add(static_cast<double>(obstacle.filter.group));
    hash.add(static_cast<double>(obstacle.filter.mask));
  }
  return hash.value();
}

}  // namespace tandem
