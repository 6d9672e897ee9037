#include "preload/own_bullet.h"

btDiscreteDynamicsWorld::btDiscreteDynamicsWorld(btDispatcher*, btBroadphaseInterface*,
                                                 btConstraintSolver*, btCollisionConfiguration*) {}
btDiscreteDynamicsWorld::~btDiscreteDynamicsWorld() = default;
int btDiscreteDynamicsWorld::stepSimulation(double dt, int max_sub_steps, double) {
  steps += dt > 0 ? 1 : 0;
  return max_sub_steps;
}
