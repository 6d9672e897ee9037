// Stands in for a program with Bullet linked in statically, which Debian has no libraries for: a
// class of that name, all of whose functions are in the program.

class btDiscreteDynamicsWorld {
 public:
  virtual ~btDiscreteDynamicsWorld();
  virtual int stepSimulation(float dt);
};

btDiscreteDynamicsWorld::~btDiscreteDynamicsWorld() = default;
int btDiscreteDynamicsWorld::stepSimulation(float dt) { return dt > 0 ? 1 : 0; }

int main() {
  btDiscreteDynamicsWorld world;
  return world.stepSimulation(0.1F) == 1 ? 0 : 1;
}
