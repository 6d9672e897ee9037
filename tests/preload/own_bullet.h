#pragma once

// Stands in for a Bullet that a plugin carries inside: a class of that name, whose functions it
// shows, so that its own calls can be come between.

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
