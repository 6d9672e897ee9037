// Stands in for a program with Bullet linked in statically; Debian has no libraries for that. All
// functions of a class of that name are in the program.

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
