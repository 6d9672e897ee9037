#include "bench/guest/guest_energy.h"

#include <cmath>

#include "tandem/bullet_bridge/convert.h"

namespace tandem::demos::bench {
namespace {

constexpr double kArena = 1.0;  // bodies nearer to the middle are judged [m]
constexpr double kLost = -0.6;  // a body lower than this has left [m]
/// No centre that can stand is as much below the floor's top [m].
constexpr double kFallen = 0.03;

/// Energy of motion and weight, with the mass that the host sees [J].
double energyOf(const GuestBody& body) {
  if (!isMoving(body) || !isInArena(body)) return 0.0;
  const btRigidBody& rigid = *body.rigid;
  const Vec3 v_W = fromBullet(rigid.getLinearVelocity());
  const Vec3 w_B =
      fromBullet(rigid.getWorldTransform().getBasis().transpose() * rigid.getAngularVelocity());
  const Vec3 inverse = fromBullet(rigid.getInvInertiaDiagLocal());
  const double scale = body.mass * static_cast<double>(rigid.getInvMass());
  double energy = 0.5 * body.mass * v_W.squaredNorm();
  for (int i = 0; i < 3; ++i)
    if (inverse[i] > 0.0) energy += 0.5 * scale * w_B[i] * w_B[i] / inverse[i];
  return energy - body.mass * fromBullet(rigid.getGravity()).dot(placeOf(body));
}

}  // namespace

Vec3 placeOf(const GuestBody& body) {
  return fromBullet(body.rigid->getWorldTransform().getOrigin());
}

bool isInArena(const GuestBody& body) {
  const Vec3 p_W = placeOf(body);
  return p_W.head<2>().cwiseAbs().maxCoeff() < kArena && p_W.z() > kLost && p_W.z() < kArena;
}

bool isBelowAll(const GuestWorld& world, const GuestBody& body) {
  return placeOf(body).z() < static_cast<double>(world.floorTop()) - kFallen;
}

bool isMoving(const GuestBody& body) {
  return body.is_in_world && body.mass > 0.0 && body.rigid->getInvMass() > 0 &&
         !body.rigid->isStaticOrKinematicObject();
}

double energyOf(const GuestWorld& world) {
  double energy = 0.0;
  for (const auto& body : world.bodies()) energy += energyOf(*body);
  const Vec3 g_W = fromBullet(world.gravity());
  for (const auto& arm : world.arms()) energy += arm->energy(g_W);
  return energy;
}

double energyOnRails(const GuestWorld& world) {
  double energy = 0.0;
  for (const auto& body : world.bodies()) {
    const btVector3& factor = body->rigid->getLinearFactor();
    if (factor.x() * factor.y() * factor.z() == 0) energy += energyOf(*body);
  }
  return energy;
}

std::size_t findLiveliest(const GuestWorld& world) {
  const auto& bodies = world.bodies();
  std::size_t most = 0;
  for (std::size_t b = 1; b < bodies.size(); ++b)
    if (energyOf(*bodies[b]) > energyOf(*bodies[most])) most = b;
  return most;
}

}  // namespace tandem::demos::bench
