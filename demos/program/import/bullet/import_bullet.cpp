#include <BulletFileLoader/btBulletFile.h>
#include <BulletWorldImporter/btBulletWorldImporter.h>

#include "tandem/bullet_bridge/convert.h"

#include "import/body_names.h"
#include "import/bullet/bullet_file.h"
#include "import/bullet/bullet_joint.h"
#include "import/bullet/bullet_shape.h"
#include "import/imported_world.h"
#include "import/trial.h"
#include "terminal/usage_error.h"
#include "world/rotation.h"

namespace tandem::demos {
namespace {

/// Deletes what it made; Bullet's own destructor does not.
struct Importer : btBulletWorldImporter {
  ~Importer() override { deleteAllData(); }
};

/// Bullet's own way from memory leaks its file where reading throws. The reader writes into
/// `bytes`.
bool load(Importer& importer, std::string& bytes) {
  bParse::btBulletFile file(bytes.data(), static_cast<int>(bytes.size()));
  return importer.loadFileFromMemory(&file);
}

BodyScenario makeBody(const btRigidBody& body, const std::string& name) {
  BodyScenario made;
  made.name = name;
  made.mass = body.getMass();
  made.position = fromBullet(body.getCenterOfMassPosition());
  made.rotation = makeRotationVector(fromBullet(body.getOrientation()).toRotationMatrix());
  made.friction = body.getFriction();
  made.restitution = body.getRestitution();
  const Vec3 inverse = fromBullet(body.getInvInertiaDiagLocal());
  if (made.mass > 0.0 && inverse.minCoeff() > 0.0) made.inertia = inverse.cwiseInverse();
  try {
    takeShape(*body.getCollisionShape(), made);
  } catch (const UsageError& error) {
    throw UsageError("body \"" + name + "\": " + error.what());
  }
  return made;
}

ImportedWorld convert(Importer& file, double host_step) {
  ImportedWorld world;
  BodyNames names;
  BulletNames named;
  for (int i = 0; i < file.getNumRigidBodies(); ++i) {
    const btRigidBody* body = btRigidBody::upcast(file.getRigidBodyByIndex(i));
    if (!body || !body->getCollisionShape()) continue;
    const char* given = file.getNameForPointer(body);
    const std::string own = given ? given : "body" + std::to_string(i + 1);
    named[body] = names.make(own);
    world.names.emplace(own, named[body]);
    world.bodies.push_back(makeBody(*body, named[body]));
  }
  for (int i = 0; i < file.getNumConstraints(); ++i)
    world.joints.push_back(makeJointScenario(*file.getConstraintByIndex(i), named, host_step));
  return world;
}

}  // namespace

ImportedWorld importBullet(const std::filesystem::path& file, double host_step) {
  const std::string bytes = readBulletFile(file);
  const auto import = [&] {
    std::string own = bytes;
    Importer importer;
    try {
      if (!load(importer, own))
        throw UsageError("Bullet cannot read this file; export it with Bullet 3");
      return convert(importer, host_step);
    } catch (const UsageError& error) {
      throw UsageError(file.string() + ": " + error.what());
    } catch (const std::exception& error) {  // of Bullet's own strings
      throw UsageError(file.string() + ": damaged: " + error.what() + "; export it again");
    }
  };
  tryInChild(file, "Bullet", [&] { (void)import(); });
  return import();
}

}  // namespace tandem::demos
