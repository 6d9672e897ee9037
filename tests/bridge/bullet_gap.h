#pragma once

#include <cmath>

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include "tandem/bullet_bridge/convert.h"

#include "coordination/src/geometry/contact_geometry.h"

namespace tandem::test {

/// The gap and normal that Bullet's GJK finds between a ball at `p` and a convex shape at the
/// origin, both turned by `turn`. Margins count.
inline SphereContact findTurnedContact(const btConvexShape& shape, const Vec3& p, double radius,
                                       const Quat& turn) {
  const btSphereShape ball(static_cast<btScalar>(radius));
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver deep;
  btGjkPairDetector detector(&ball, &shape, &simplex, &deep);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = toBullet(turn * p, Quat::Identity());
  input.m_transformB = toBullet(Vec3::Zero(), turn);
  btPointCollector found;
  detector.getClosestPoints(input, found, nullptr);
  return {static_cast<double>(found.m_distance),
          turn.conjugate() * fromBullet(found.m_normalOnBInWorld),
          turn.conjugate() * fromBullet(found.m_pointInWorld)};
}

/// The same, as well as Bullet can. Its search begins along y and has limits in Bullet's unit: in
/// metres it stops early on shapes of some centimetres, by up to 9 mm in float. So it is done in
/// millimetres, and from several directions. What stopped early found too much: the least is right.
inline SphereContact findBulletContact(const btConvexShape& shape, const Vec3& p, double radius) {
  constexpr double kMillimetres = 1000.0;
  // It takes the shape by non-const pointer, and does not change it.
  const btUniformScalingShape large(const_cast<btConvexShape*>(&shape), btScalar(kMillimetres));
  SphereContact least;
  for (int i = 0; i < 4; ++i) {
    const Vec3 to(0.3 * std::sin(2.0 * i), 1.0, 0.2 * i);
    const SphereContact found =
        findTurnedContact(large, kMillimetres * p, kMillimetres * radius,
                          Quat::FromTwoVectors(p, i > 0 ? to : Vec3::UnitY()));
    if (i == 0 || found.gap < least.gap) least = found;
  }
  least.gap /= kMillimetres;
  least.p_W /= kMillimetres;
  return least;
}

}  // namespace tandem::test
