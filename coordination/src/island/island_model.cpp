#include "island/island_model.h"

#include <algorithm>

#include "geometry/turn.h"

namespace tandem {
namespace {

/// Squares of the longest lever arms of surface points about the axes [m^2].
Vec3 computeArms(const Shape& shape, double bounding_radius) noexcept {
  const double square = bounding_radius * bounding_radius;
  const auto around = [square](double radius, Axis axis) {
    Vec3 arms = Vec3::Constant(square);
    arms[static_cast<int>(axis)] = radius * radius;
    return arms;
  };
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return around(capsule->radius, capsule->axis);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    return around(cylinder->radius, cylinder->axis);
  if (const auto* cone = std::get_if<Cone>(&shape))
    return around(cone->radius + cone->rounding, cone->axis);
  return Vec3::Constant(square);
}

/// Largest velocity per impulse that a push on a box's surface gives by turning it [1/kg].
///
/// A push along the normal of a face has arms in that face. Over an edge or corner it is a mixture
/// of these whose arms are shorter: each axis then has the difference of two of them.
double computeBoxTurning(const Box& box, const Vec3& inverse_inertia_B, bool is_even) noexcept {
  const Vec3 h = box.half_extents.cwiseAbs2();
  // Uneven factors mix the axes.
  const Vec3 inverse =
      is_even ? inverse_inertia_B : Vec3(Vec3::Constant(inverse_inertia_B.maxCoeff()));
  return std::max({inverse.y() * h.z() + inverse.z() * h.y(),
                   inverse.x() * h.z() + inverse.z() * h.x(),
                   inverse.x() * h.y() + inverse.y() * h.x()});
}

MassFactors computeFactors(const IslandBody& settings) noexcept {
  MassFactors factors;
  const auto split = [](const Vec3& all, double& largest, Vec3& shares) {
    largest = all.maxCoeff() > 0.0 ? all.maxCoeff() : 1.0;
    shares = all / largest;
    return shares == Vec3::Ones();
  };
  factors.way_is_even = split(settings.linear_factor, factors.linear, factors.way_W);
  Vec3 turn_W;
  factors.turn_is_even = split(settings.angular_factor, factors.angular, turn_W);
  factors.turn_root_W = turn_W.cwiseSqrt();
  return factors;
}

}  // namespace

ModelBody ModelBody::make(const IslandBody& settings, bool is_guided) noexcept {
  ModelBody body;
  body.state = settings.start;
  body.contact_share = settings.contact_share;
  body.bounding_radius = computeBoundingRadius(settings.shape);
  body.takeMass(settings, is_guided);
  return body;
}

void ModelBody::takeMass(const IslandBody& changed, bool is_guided) noexcept {
  settings = changed;
  if (is_guided) settings.linear_factor = settings.angular_factor = Vec3::Ones();
  if (settings.motion != Motion::kDynamic) return;
  factors = settings.hasFactors() ? computeFactors(changed) : MassFactors{};
  inverse_mass = mobility = factors.linear / settings.mass;
  inverse_inertia_B.setZero();
  if (is_guided) return;
  for (int axis = 0; axis < 3; ++axis)
    if (settings.inertia_B[axis] > 0.0)
      inverse_inertia_B[axis] = factors.angular / settings.inertia_B[axis];
  if (const auto* box = std::get_if<Box>(&settings.shape)) {
    mobility += computeBoxTurning(*box, inverse_inertia_B, factors.turn_is_even);
    return;
  }
  const double radius = bounding_radius;
  mobility += std::min(inverse_inertia_B.maxCoeff() * radius * radius,
                       inverse_inertia_B.dot(computeArms(settings.shape, radius)));
}

ModelBody ModelBody::makeEmpty(bool is_slot) noexcept {
  ModelBody body;
  body.is_slot = is_slot;
  body.is_active = false;
  return body;
}

void IslandModel::reserveLists() {
  present.reserve(bodies.size());
  present_contacts.reserve(contacts.size());
  present_couplers.reserve(couplers.size());
  present_grips.reserve(grips.size());
}

void IslandModel::listPresent() noexcept {
  present.clear();
  present_contacts.clear();
  present_couplers.clear();
  present_grips.clear();
  asleep_count = 0;
  for (BodyIndex b = 0; b < static_cast<BodyIndex>(bodies.size()); ++b) {
    if (bodies[b].isPresent()) present.push_back(b);
    asleep_count += bodies[b].is_asleep;
  }
  const auto meets = [&](BodyIndex b) { return bodies[b].isPresent() && !bodies[b].is_ghost; };
  const auto touches = [&](BodyIndex b) { return meets(b) && !bodies[b].has_tool; };
  for (const IslandContact& contact : contacts)
    if (touches(contact.sphere) && touches(contact.other) &&
        letsMeet(contact.sphere, contact.other) && !areJoined(contact.sphere, contact.other))
      present_contacts.push_back(contact);
  for (std::size_t c = 0; c < couplers.size(); ++c)
    if (bodies[couplers[c].follower].isPresent()) present_couplers.push_back(static_cast<int>(c));
  for (std::size_t g = 0; g < grips.size(); ++g)
    if (grips[g].is_on && grips[g].hold.share > 0.0 && meets(grips[g].hand) &&
        meets(grips[g].hold.body))
      present_grips.push_back(static_cast<int>(g));
  is_listed = true;
}

Wrench computeCouplerWrench(const ModelCoupler& coupler, const RigidState& follower) noexcept {
  Wrench wrench;
  wrench.f_W = computeCouplerForce(coupler.now.linear, coupler.target.point(), follower.point());
  const CouplerGains& angular = coupler.now.angular;
  if (angular.stiffness != 0.0 || angular.damping != 0.0)
    wrench.t_W = angular.stiffness *
                     computeTurn(follower.q_WB.coeffs().data(), coupler.target.q_WB.coeffs().data())
                         .toVec3() +
                 angular.damping * (coupler.target.w_W - follower.w_W);
  return wrench;
}

Vec3 computeAngularDamping(const IslandBody& body, const RigidState& state) noexcept {
  if (body.angular_damping == 0.0) return Vec3::Zero();
  const Vec3 spin_B = body.inertia_B.cwiseProduct(state.q_WB.conjugate() * state.w_W);
  return -body.angular_damping * (state.q_WB * spin_B);
}

void goOn(RigidState& state, double dt) noexcept {
  state.p_W += dt * state.v_W;
  const double speed = state.w_W.norm();
  if (speed == 0.0) return;
  const Quat turn(Eigen::AngleAxisd(dt * speed, state.w_W / speed));
  state.q_WB = (turn * state.q_WB).normalized();
}

RigidState extrapolate(const ModelBody& body, double dt) noexcept {
  RigidState state = body.state;
  if (body.settings.motion == Motion::kPrescribed) goOn(state, dt);
  return state;
}

}  // namespace tandem
