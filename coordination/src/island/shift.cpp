#include "island/shift.h"

#include <algorithm>

namespace tandem {
namespace {

constexpr int kSweeps = 8;

/// How far a point of contact went along the normal that points to the body [m].
double computeWay(const RigidContact& contact, const Vec3& n_W, const RigidState& from,
                  const RigidState& to) noexcept {
  const Vec3 arm_W = contact.p_W - to.p_W;
  const Vec3 before_W = from.p_W + from.q_WB * (to.q_WB.conjugate() * arm_W);
  return n_W.dot(contact.p_W - before_W);
}

}  // namespace

Vec3 limitShift(ContactFinder& finder, BodyIndex body, const Vec3& offset_W, const Quat& rotation_W,
                States& states, std::vector<RigidContact>& contacts) noexcept {
  const RigidState from = states[body];
  RigidState& to = states[body];
  to.p_W += offset_W;
  to.q_WB = (rotation_W * to.q_WB).normalized();
  contacts.clear();
  finder.find(states, contacts);
  Vec3 back_W = Vec3::Zero();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double most = 0.0;
    for (const RigidContact& contact : contacts) {
      if (contact.a != body && contact.b != body) continue;
      const Vec3 n_W = contact.a == body ? contact.n_W : Vec3(-contact.n_W);
      const double allowed = std::min(0.0, contact.distance - computeWay(contact, n_W, from, to));
      const double missing = allowed - (contact.distance + n_W.dot(back_W));
      if (missing <= 0.0) continue;
      back_W += missing * n_W;
      most = std::max(most, missing);
    }
    if (most == 0.0) break;
  }
  return offset_W + back_W;
}

}  // namespace tandem
