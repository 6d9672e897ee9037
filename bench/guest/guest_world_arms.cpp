#include <utility>

#include "bench/guest/guest_world.h"

// Worlds with arms, and without.

namespace tandem::demos::bench {
namespace {

/// Makes a world of a kind, and shows what is watched in it.
template <typename World, typename Solver>
std::unique_ptr<btDiscreteDynamicsWorld> makeWatched(btDispatcher& dispatcher,
                                                     btBroadphaseInterface& broadphase,
                                                     Solver& solver,
                                                     btCollisionConfiguration& configuration,
                                                     const GuestWatch*& watch) {
  auto world =
      std::make_unique<WatchedWorld<World>>(&dispatcher, &broadphase, &solver, &configuration);
  watch = world.get();
  return world;
}

std::unique_ptr<btBroadphaseInterface> makeBroadphase(GuestBroadphase kind) {
  const btVector3 half(100, 100, 100);  // of the space in which sweeps tell bodies apart [m]
  constexpr int kMostBodies = 1000;
  switch (kind) {
    case GuestBroadphase::kAxisSweep:
      return std::make_unique<btAxisSweep3>(-half, half, kMostBodies);
    case GuestBroadphase::kAxisSweep32:
      return std::make_unique<bt32BitAxisSweep3>(-half, half, kMostBodies);
    case GuestBroadphase::kPairs:
      return std::make_unique<btSimpleBroadphase>(kMostBodies);
    case GuestBroadphase::kTrees:
      break;
  }
  return std::make_unique<btDbvtBroadphase>();
}

}  // namespace

GuestWorld::Physics::Physics(const GuestCase& one) : broadphase(makeBroadphase(one.broadphase)) {
  if (one.broadphase != GuestBroadphase::kTrees)
    broadphase->getOverlappingPairCache()->setInternalGhostPairCallback(&ghost_pairs);
  if (!one.arms.empty()) {
    auto own = std::make_unique<btMultiBodyConstraintSolver>();
    world =
        makeWatched<btMultiBodyDynamicsWorld>(dispatcher, *broadphase, *own, configuration, watch);
    solver = std::move(own);
  } else {
    solver = std::make_unique<btSequentialImpulseConstraintSolver>();
    world = makeWatched<btDiscreteDynamicsWorld>(dispatcher, *broadphase, *solver, configuration,
                                                 watch);
  }
}

std::unique_ptr<btConstraintSolver> GuestWorld::makeSolver() const {
  if (case_.arms.empty()) return std::make_unique<btSequentialImpulseConstraintSolver>();
  return std::make_unique<btMultiBodyConstraintSolver>();
}

void GuestWorld::makeArms() {
  for (const GuestArmPlan& plan : case_.arms) {
    arms_.push_back(std::make_unique<GuestArm>(plan, case_.step()));
    addArm(*arms_.back());
    Draw draw(plan.seed, 1);
    if (plan.has_tie) addTie(draw);
  }
}

void GuestWorld::addArm(GuestArm& arm) { arm.add(static_cast<btMultiBodyDynamicsWorld&>(world())); }

void GuestWorld::toggleArm(GuestArm& arm) { arm.isInWorld() ? arm.remove() : addArm(arm); }

void GuestWorld::addTie(Draw& draw) {
  if (arms_.empty()) return;
  const int count = static_cast<int>(arms_.size());
  GuestArm& arm = *arms_[static_cast<std::size_t>(draw.count(0, count - 1))];
  const int last = arm.body().getNumLinks() - 1, link = draw.count(0, last);
  const double to = draw.even(0.0, 1.0);
  GuestBody& body = drawDynamicBody(draw);
  const int other = draw.count(0, last);
  if (to < 0.4) {
    if (body.is_in_world && body.plan.role != GuestRole::kFar &&
        !body.rigid->isStaticOrKinematicObject())
      arm.addTie(link, body.rigid, -1, draw);
  } else {
    arm.addTie(link, nullptr, to < 0.7 ? other : -1, draw);
  }
}

}  // namespace tandem::demos::bench
