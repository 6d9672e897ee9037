#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace tandem::demos::bench {

using Vec2 = Eigen::Vector2d;

/// z component of a x b.
[[nodiscard]] inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}
/// `a` turned by a quarter, counterclockwise: velocity of a point at `a` per unit of angular
/// velocity.
[[nodiscard]] inline Vec2 turnQuarter(const Vec2& a) { return {-a.y(), a.x()}; }

enum class PlanarShape { kBox, kCircle, kHalfPlane };

/// A rigid body in the plane. Angles and angular velocity are counterclockwise.
struct PlanarBody {
  PlanarShape shape = PlanarShape::kBox;
  Vec2 half = Vec2::Constant(0.02);  ///< half edges of a box [m]
  double radius = 0.02;              ///< radius of a circle [m]
  Vec2 normal = Vec2::UnitY();       ///< outward normal of a half-plane
  double mass = 0.0;                 ///< [kg]; 0: static
  double inertia = 0.0;              ///< moment about the centre [kg m^2]
  Vec2 p = Vec2::Zero();             ///< centre, or a point of the half-plane's edge [m]
  double angle = 0.0;                ///< [rad]
  Vec2 v = Vec2::Zero();             ///< [m/s]
  double w = 0.0;                    ///< [rad/s]

  [[nodiscard]] double inverseMass() const { return mass > 0.0 ? 1.0 / mass : 0.0; }
  [[nodiscard]] double inverseInertia() const { return mass > 0.0 ? 1.0 / inertia : 0.0; }
  [[nodiscard]] Vec2 velocityAt(const Vec2& point) const { return v + w * turnQuarter(point - p); }
};

/// A joint of body `a` with body `b`, or with the plane itself. Its coordinate is the turn of `a`
/// against `b`, counterclockwise, or the way of its pivot along `axis`; both from the start.
struct PlanarJoint {
  struct Limit {
    double low = 0.0, high = 0.0;  ///< [rad or m]
  };
  struct Motor {
    double speed = 0.0;  ///< wanted rate of the coordinate [rad/s or m/s]
    double force = 0.0;  ///< the most that it gives [N m or N]
  };

  bool is_slider = false;  ///< else a hinge
  std::size_t a = 0;
  std::optional<std::size_t> b;  ///< none: the plane itself
  Vec2 at_a = Vec2::Zero();      ///< pivot in the frame of `a` [m]
  Vec2 at_b = Vec2::Zero();      ///< pivot in the frame of `b` [m]
  Vec2 axis = Vec2::UnitX();     ///< way of a slider in the frame of `b`, of length 1
  double turn = 0.0;             ///< of `a` against `b` at the start [rad]
  std::optional<Limit> limit;
  std::optional<Motor> motor;
};

/// A circle held by a spring-damper. It touches bodies by compliant contact without friction, and
/// no other tool.
struct PlanarTool {
  double radius = 0.01;  ///< [m]
  double mass = 0.1;     ///< [kg]
  Vec2 p = Vec2::Zero();
  Vec2 v = Vec2::Zero();
  Vec2 force = Vec2::Zero();  ///< constant [N]
  bool is_held = false;       ///< the coupler holds it at the target
  Vec2 target_p = Vec2::Zero();
  Vec2 target_v = Vec2::Zero();
};

struct PlanarScene {
  Vec2 gravity = Vec2::Zero();                            ///< acts on bodies [m/s^2]
  double friction = 0.0;                                  ///< coefficient of every pair of bodies
  double coupler_stiffness = 0.0, coupler_damping = 0.0;  ///< [N/m, N s/m]
  double contact_stiffness = 0.0, contact_damping = 0.0;  ///< between tool and body [N/m, N s/m]
  std::vector<PlanarBody> bodies;
  std::vector<PlanarTool> tools;
  std::vector<PlanarJoint> joints;  ///< joined bodies do not touch each other
};

}  // namespace tandem::demos::bench
