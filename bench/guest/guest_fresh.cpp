#include "bench/guest/guest_fresh.h"

#include <fmt/format.h>

#include "bench/guest/guest_site.h"

namespace tandem::demos::bench {
namespace {

constexpr int kSteps = 12;

/// Gives a body the motion of another. All else stays its own.
void takeMotion(btRigidBody& body, const btRigidBody& from) {
  body.setWorldTransform(from.getWorldTransform());
  body.setInterpolationWorldTransform(from.getWorldTransform());
  body.setLinearVelocity(from.getLinearVelocity());
  body.setAngularVelocity(from.getAngularVelocity());
  body.setInterpolationLinearVelocity(from.getLinearVelocity());
  body.setInterpolationAngularVelocity(from.getAngularVelocity());
  body.clearForces();
  body.updateInertiaTensor();
  body.setHitFraction(1);
}

}  // namespace

std::string compareFreshWorlds(GuestSite& site) {
  GuestWorld &own = site.world(), &twin = site.twin();
  for (std::size_t b = 0; b < own.bodies().size(); ++b) {
    btRigidBody &body = *own.bodies()[b]->rigid, &other = *twin.bodies()[b]->rigid;
    takeMotion(body, body);
    takeMotion(other, body);
    own.bodies()[b]->motion_state.m_graphicsWorldTrans = body.getWorldTransform();
    twin.bodies()[b]->motion_state.m_graphicsWorldTrans = body.getWorldTransform();
    other.forceActivationState(body.getActivationState());
    other.setDeactivationTime(body.getDeactivationTime());
    if (!own.bodies()[b]->has_unclear_gravity) continue;
    body.setGravity(body.getGravity());
    other.setGravity(body.getGravity());
  }
  for (std::size_t a = 0; a < own.arms().size(); ++a) {
    own.arms()[a]->takeMotion(*own.arms()[a]);
    twin.arms()[a]->takeMotion(*own.arms()[a]);
  }
  takeMotion(twin.floor(), own.floor());
  own.beginNewWorld();
  twin.beginNewWorld();
  for (int step = 0; step < kSteps; ++step) {
    own.step(step * own.plan().frame, {});
    twin.step(step * own.plan().frame, {});
    for (std::size_t b = 0; b < own.bodies().size(); ++b) {
      const btRigidBody &body = *own.bodies()[b]->rigid, &other = *twin.bodies()[b]->rigid;
      if (body.getWorldTransform() == other.getWorldTransform() &&
          body.getLinearVelocity() == other.getLinearVelocity() &&
          body.getAngularVelocity() == other.getAngularVelocity())
        continue;
      return fmt::format("body {} differs from a fresh one after {} steps", b, step + 1);
    }
    for (std::size_t a = 0; a < own.arms().size(); ++a)
      if (!own.arms()[a]->isAt(*twin.arms()[a]))
        return fmt::format("arm {} differs from a fresh one after {} steps", a, step + 1);
  }
  return {};
}

}  // namespace tandem::demos::bench
