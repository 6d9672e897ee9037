#pragma once

// Stands in for a Bullet inside a plugin. A class of that name exports its functions, so its own
// calls can be intercepted.

class btDispatcher;
class btBroadphaseInterface;
class btConstraintSolver;
class btCollisionConfiguration;

class [[gnu::visibility("default")]] btDiscreteDynamicsWorld {
 public:
  btDiscreteDynamicsWorld(btDispatcher*, btBroadphaseInterface*, btConstraintSolver*,
                          btCollisionConfiguration*);
  virtual ~btDiscreteDynamicsWorld();
  virtual int stepSimulation(double dt, int max_sub_steps, double fixed_step);
  int steps = 0;
};
