#include "arms/arm_model.h"

#include <cmath>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/rotation_vector.h"

namespace tandem {
namespace {

LinkKind readKind(btMultibodyLink::eFeatherstoneJointType type) {
  switch (type) {
    case btMultibodyLink::eRevolute:
      return LinkKind::kRevolute;
    case btMultibodyLink::ePrismatic:
      return LinkKind::kPrismatic;
    case btMultibodyLink::eSpherical:
      return LinkKind::kSpherical;
    case btMultibodyLink::ePlanar:
      return LinkKind::kPlanar;
    default:
      return LinkKind::kFixed;
  }
}

Quat makeQuat(const std::array<double, 4>& q) { return Quat(q[3], q[0], q[1], q[2]).normalized(); }

/// Orientation of the link in its parent.
Quat findTurn(const ArmLink& link, const ArmCoordinates::Joint& joint) {
  switch (link.kind) {
    case LinkKind::kRevolute:
    case LinkKind::kPlanar:
      return link.q_PZ * makeRotation(joint.q[0] * link.turn[0]);
    case LinkKind::kSpherical:
      return link.q_PZ * makeQuat(joint.q);
    case LinkKind::kPrismatic:
    case LinkKind::kFixed:
      break;
  }
  return link.q_PZ;
}

/// Way that the joint has slid, in the frame at zero [m].
Vec3 findSlide(const ArmLink& link, const ArmCoordinates::Joint& joint) {
  if (link.kind == LinkKind::kPrismatic) return joint.q[0] * link.slide[0];
  if (link.kind == LinkKind::kPlanar)
    return joint.q[1] * link.slide[1] + joint.q[2] * link.slide[2];
  return Vec3::Zero();
}

/// The angle of a turn about an axis, nearest to `near` [rad].
double findAngle(const Quat& turn, const Vec3& axis, double near) {
  const double angle = 2.0 * std::atan2(turn.vec().dot(axis), turn.w());
  return near + std::remainder(angle - near, 2.0 * M_PI);
}

}  // namespace

ArmModel::ArmModel(const btMultiBody& body) {
  links_.resize(static_cast<std::size_t>(body.getNumLinks()) + 1);
  ArmLink& base = links_[0];
  base.mass = static_cast<double>(body.getBaseMass());
  base.inertia = fromBullet(body.getBaseInertia());
  if (body.hasFixedBase()) base.role = LinkRole::kGround;
  for (std::size_t place = 1; place < links_.size(); ++place) {
    const btMultibodyLink& from = body.getLink(static_cast<int>(place) - 1);
    ArmLink& link = links_[place];
    link.kind = readKind(from.m_jointType);
    link.parent = static_cast<std::size_t>(from.m_parent + 1);
    link.mass = static_cast<double>(from.m_mass);
    link.inertia = fromBullet(from.m_inertiaLocal);
    link.d = fromBullet(from.m_dVector);
    link.e = fromBullet(from.m_eVector);
    link.q_PZ = fromBullet(from.m_zeroRotParentToThis).conjugate();
    link.dofs = static_cast<std::size_t>(from.m_dofCount);
    for (std::size_t i = 0; i < link.turn.size(); ++i) {
      const bool is_used = i < link.dofs;
      link.turn[i] = is_used ? fromBullet(from.m_axes[i].m_topVec) : Vec3(Vec3::Zero());
      link.slide[i] = is_used ? fromBullet(from.m_axes[i].m_bottomVec) : Vec3(Vec3::Zero());
    }
    if (link.kind != LinkKind::kFixed) continue;
    if (links_[link.parent].role == LinkRole::kGround)
      link.role = LinkRole::kGround;
    else if (!(link.mass > 0.0))
      link.role = LinkRole::kFrame;
  }
}

std::size_t ArmModel::carrier(std::size_t place) const noexcept {
  while (links_[place].role == LinkRole::kFrame) place = links_[place].parent;
  return place;
}

std::size_t ArmModel::countBodies() const noexcept {
  std::size_t count = 0;
  for (const ArmLink& link : links_) count += link.role == LinkRole::kBody ? 1 : 0;
  return count;
}

void ArmModel::read(const btMultiBody& body, ArmCoordinates& into) {
  into.joints.resize(static_cast<std::size_t>(body.getNumLinks()) + 1);
  into.base.p_W = fromBullet(body.getBasePos());
  into.base.q_WB = fromBullet(body.getWorldToBaseRot()).conjugate();
  into.base.v_W = fromBullet(body.getBaseVel());
  into.base.w_W = fromBullet(body.getBaseOmega());
  for (int i = 0; i < body.getNumLinks(); ++i) {
    const btMultibodyLink& link = body.getLink(i);
    ArmCoordinates::Joint& joint = into.joints[static_cast<std::size_t>(i) + 1];
    for (int k = 0; k < link.m_posVarCount; ++k)
      joint.q[static_cast<std::size_t>(k)] = static_cast<double>(link.m_jointPos[k]);
    for (int k = 0; k < link.m_dofCount; ++k)
      joint.u[static_cast<std::size_t>(k)] = static_cast<double>(body.getJointVelMultiDof(i)[k]);
  }
}

void ArmModel::write(const ArmCoordinates& from, btMultiBody& body) const noexcept {
  if (!isBaseFixed()) {
    body.setBasePos(toBullet(from.base.p_W));
    body.setWorldToBaseRot(toBullet(from.base.q_WB.conjugate()));
    body.setBaseVel(toBullet(from.base.v_W));
    body.setBaseOmega(toBullet(from.base.w_W));
  }
  for (int i = 0; i < body.getNumLinks(); ++i) {
    const ArmCoordinates::Joint& joint = from.joints[static_cast<std::size_t>(i) + 1];
    body.setJointPosMultiDof(i, joint.q.data());
    body.setJointVelMultiDof(i, joint.u.data());
  }
}

void ArmModel::findLinks(const ArmCoordinates& from,
                         std::vector<RigidState>& links) const noexcept {
  links[0] = from.base;
  for (std::size_t place = 1; place < links_.size(); ++place) findLink(place, from, links);
}

void ArmModel::findLink(std::size_t place, const ArmCoordinates& from,
                        std::vector<RigidState>& links) const noexcept {
  const ArmLink& link = links_[place];
  const ArmCoordinates::Joint& joint = from.joints[place];
  const RigidState& parent = links[link.parent];
  RigidState& state = links[place];
  state.q_WB = (parent.q_WB * findTurn(link, joint)).normalized();
  // A planar joint slides in the frame at zero, a prismatic one does not turn.
  const Vec3 slide_P = link.q_PZ * findSlide(link, joint);
  state.p_W = parent.p_W + parent.q_WB * (link.e + slide_P) + state.q_WB * link.d;
  Vec3 turn = Vec3::Zero(), slide = Vec3::Zero();
  for (std::size_t i = 0; i < link.dofs; ++i) {
    turn += joint.u[i] * link.turn[i];
    slide += joint.u[i] * link.slide[i];
  }
  state.w_W = parent.w_W + state.q_WB * turn;
  state.v_W = parent.v_W + parent.w_W.cross(state.p_W - parent.p_W) + state.q_WB * slide;
}

void ArmModel::findCoordinates(std::vector<RigidState>& links, ArmCoordinates& into,
                               double dt) const noexcept {
  if (isBaseFixed())
    links[0] = into.base;
  else
    into.base = links[0];
  for (std::size_t place = 1; place < links_.size(); ++place) {
    const ArmLink& link = links_[place];
    if (link.role != LinkRole::kBody) {
      findLink(place, into, links);
      continue;
    }
    ArmCoordinates::Joint& joint = into.joints[place];
    const RigidState &parent = links[link.parent], &state = links[place];
    const Quat q_ZL = link.q_PZ.conjugate() * (parent.q_WB.conjugate() * state.q_WB);
    const Vec3 way_P =
        parent.q_WB.conjugate() * (state.p_W - state.q_WB * link.d - parent.p_W) - link.e;
    const Vec3 way = link.q_PZ.conjugate() * way_P;
    const Quat q_LW = state.q_WB.conjugate();
    const Vec3 w = q_LW * (state.w_W - parent.w_W);
    const Vec3 v = q_LW * (state.v_W - parent.v_W - parent.w_W.cross(state.p_W - parent.p_W));
    const auto turn = [&](double u) {
      const double near = joint.q[0] + 0.5 * dt * (joint.u[0] + u);
      joint.q[0] = findAngle(q_ZL, link.turn[0], near);
      joint.u[0] = u;
    };
    switch (link.kind) {
      case LinkKind::kRevolute:
        turn(link.turn[0].dot(w));
        break;
      case LinkKind::kPrismatic:
        joint.q[0] = link.slide[0].dot(way);
        joint.u[0] = link.slide[0].dot(v);
        break;
      case LinkKind::kSpherical: {
        const bool is_near = makeQuat(joint.q).coeffs().dot(q_ZL.coeffs()) >= 0.0;
        const Quat q = is_near ? q_ZL : Quat(-q_ZL.coeffs());
        joint.q = {q.x(), q.y(), q.z(), q.w()};
        joint.u = {w.x(), w.y(), w.z()};
        break;
      }
      case LinkKind::kPlanar:
        turn(link.turn[0].dot(w));
        for (std::size_t i = 1; i < 3; ++i) {
          joint.q[i] = link.slide[i].dot(way);
          joint.u[i] = link.slide[i].dot(v);
        }
        break;
      case LinkKind::kFixed:
        break;
    }
  }
}

void ArmModel::findMeanVelocity(const ArmCoordinates& start, const ArmCoordinates& end, double dt,
                                ArmCoordinates& mean) const noexcept {
  mean.base = start.base;
  if (!isBaseFixed()) {
    mean.base.v_W = (end.base.p_W - start.base.p_W) / dt;
    mean.base.w_W = computeRotationVector(start.base.q_WB, end.base.q_WB) / dt;
  }
  for (std::size_t place = 1; place < links_.size(); ++place) {
    const ArmLink& link = links_[place];
    const ArmCoordinates::Joint &from = start.joints[place], &to = end.joints[place];
    ArmCoordinates::Joint& joint = mean.joints[place];
    joint.q = from.q;
    joint.u = {};
    if (link.kind == LinkKind::kFixed) continue;
    if (link.kind == LinkKind::kSpherical) {
      const Quat at = makeQuat(from.q);
      const Vec3 w = at.conjugate() * computeRotationVector(at, makeQuat(to.q)) / dt;
      joint.u = {w.x(), w.y(), w.z()};
      continue;
    }
    joint.u[0] = (to.q[0] - from.q[0]) / dt;
    if (link.kind != LinkKind::kPlanar) continue;
    // Bullet takes the way along axes that have turned to the end of the step.
    const Vec3 way = (to.q[1] - from.q[1]) * link.slide[1] + (to.q[2] - from.q[2]) * link.slide[2];
    const Vec3 turned = makeRotation(-to.q[0] * link.turn[0]) * way / dt;
    joint.u[1] = link.slide[1].dot(turned);
    joint.u[2] = link.slide[2].dot(turned);
  }
}

void ArmModel::findJointImpulses(const std::vector<RigidState>& links,
                                 std::vector<Momentum>& momenta,
                                 std::vector<std::array<double, 3>>& impulses) const noexcept {
  for (std::size_t place = links_.size(); place-- > 1;) {
    const ArmLink& link = links_[place];
    const Momentum& own = momenta[place];
    const Quat q_LW = links[place].q_WB.conjugate();
    const Vec3 linear = q_LW * own.linear_W, angular = q_LW * own.angular_W;
    for (std::size_t i = 0; i < link.dofs; ++i)
      impulses[place][i] = link.turn[i].dot(angular) + link.slide[i].dot(linear);
    Momentum& sum = momenta[link.parent];
    sum.angular_W +=
        own.angular_W + (links[place].p_W - links[link.parent].p_W).cross(own.linear_W);
    sum.linear_W += own.linear_W;
  }
}

}  // namespace tandem
