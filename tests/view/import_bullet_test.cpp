// Worlds from .bullet files that Bullet itself writes, and files that are none.

#include <cmath>
#include <memory>
#include <random>

#include <btBulletDynamicsCommon.h>

#include "import/imported_world.h"
#include "run/virtual_run.h"
#include "scenario/scenario.h"
#include "support/temp_folder.h"
#include "view/refused_file.h"
#include "world/scene_world.h"

namespace tandem::demos {
namespace {

constexpr double kStep = 1.0 / 60.0;  // [s]

/// A hinged door, a compound and a ball, as a host of Bullet would have them.
class Host {
 public:
  Host() {
    parts_.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(1, 0, 0)), &box_);
    parts_.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(-1, 0, 0)), &stick_);
    add(box_, 2, btTransform(btQuaternion::getIdentity(), btVector3(1, 2, 3)));
    add(parts_, 1,
        btTransform(btQuaternion(btVector3(1, 2, 3), btScalar(0.5)), btVector3(0, 0, 5)));
    add(ball_, 0, btTransform(btQuaternion::getIdentity(), btVector3(4, 0, 0)));
    hinge_ = std::make_unique<btHingeConstraint>(*bodies_[0], btVector3(0, btScalar(0.2), 0),
                                                 btVector3(0, 0, 1));
    hinge_->setLimit(btScalar(-0.5), btScalar(1.5));
    hinge_->enableAngularMotor(true, 0, btScalar(0.1 * kStep));
    world_.addConstraint(hinge_.get(), true);
  }
  ~Host() {
    world_.removeConstraint(hinge_.get());
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  [[nodiscard]] std::string serialize() {
    btDefaultSerializer serializer;
    serializer.registerNameForPointer(bodies_[0].get(), "door leaf");
    serializer.registerNameForPointer(bodies_[1].get(), "cup");
    world_.serialize(&serializer);
    return {reinterpret_cast<const char*>(serializer.getBufferPointer()),
            static_cast<std::size_t>(serializer.getCurrentBufferSize())};
  }
  [[nodiscard]] const btRigidBody& body(std::size_t i) const { return *bodies_[i]; }

 private:
  void add(btCollisionShape& shape, btScalar mass, const btTransform& start) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform = start;
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(bodies_.back().get());
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btBoxShape box_{btVector3(btScalar(0.1), btScalar(0.2), btScalar(0.3))};
  btCapsuleShapeX stick_{btScalar(0.1), btScalar(0.5)};
  btSphereShape ball_{btScalar(0.25)};
  btCompoundShape parts_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::unique_ptr<btHingeConstraint> hinge_;
};

ImportedWorld import(const std::filesystem::path& file) { return importBullet(file, kStep); }

TEST(ImportBullet, BodiesComeBackAsTheyWere) {
  Host host;
  const test::TempFolder files;
  const ImportedWorld world = import(files.write("w.bullet", host.serialize()));
  ASSERT_EQ(world.bodies.size(), 3u);
  EXPECT_EQ(world.names.at("door leaf"), "door_leaf");
  EXPECT_EQ(world.bodies[0].name, "door_leaf");
  EXPECT_EQ(world.bodies[1].name, "cup");
  Scenario scenario =
      parseScenario("[experiment]\nkind = \"playground\"\nguide = false\n", "s", {});
  scenario.kind = "world";
  scenario.bodies = world.bodies;
  const SceneWorld scene(scenario);
  for (std::size_t i = 0; i < 3; ++i) {
    const btRigidBody &here = *scene.bodies()[i].body, &there = host.body(i);
    EXPECT_NEAR(here.getMass(), there.getMass(), 1e-6);
    EXPECT_LT((here.getCenterOfMassPosition() - there.getCenterOfMassPosition()).length(), 1e-6);
    EXPECT_LT(here.getOrientation().angleShortestPath(there.getOrientation()), 1e-6);
    EXPECT_LT((here.getLocalInertia() - there.getLocalInertia()).length(), 1e-6);
    btVector3 low, high, low_there, high_there;
    here.getAabb(low, high);
    there.getAabb(low_there, high_there);
    EXPECT_LT((low - low_there).length() + (high - high_there).length(), 1e-3);
  }
}

TEST(ImportBullet, AHingeComesBackWithLimitsAndFriction) {
  Host host;
  const test::TempFolder files;
  const ImportedWorld world = import(files.write("w.bullet", host.serialize()));
  ASSERT_EQ(world.joints.size(), 1u);
  const JointScenario& hinge = world.joints[0];
  EXPECT_EQ(hinge.bodies, std::vector<std::string>{"door_leaf"});
  EXPECT_TRUE(hinge.axis.isApprox(Vec3::UnitZ(), 1e-6)) << hinge.axis;
  EXPECT_NEAR((*hinge.limits)[0], -0.5, 1e-6);
  EXPECT_NEAR((*hinge.limits)[1], 1.5, 1e-6);
  EXPECT_NEAR(hinge.friction, 0.1, 1e-6);
  EXPECT_TRUE(hinge.at.isApprox(Vec3(1, 2.2, 3), 1e-6)) << hinge.at;
}

// Without ties between the copies, each falls by g t^2 / 2.
TEST(ImportBullet, RunsInPlaceOfAScenario) {
  Host host;
  const test::TempFolder files;
  const auto file = files.write("w.bullet", host.serialize());
  VirtualRun run(loadScenario(file, {"world.share=[\"cup\"]", "experiment.duration=0.2",
                                     "coordination.stiffness=0", "coordination.damping=0"}));
  run.run();
  for (const int site : {0, 1}) {
    EXPECT_EQ(run.world(site).site().status(), kTickOk);
    EXPECT_NEAR(run.world(site).site().object(0).p_W.z(), 5.0 - 0.5 * 9.81 * 0.04, 2e-3);
  }
  expectRefused(file, "there are: cup, door leaf",
                [](const auto& path) { return loadScenario(path, {"world.share=[\"mug\"]"}); });
}

TEST(ImportBullet, BadFilesAreRefusedInALine) {
  Host host;
  const std::string whole = host.serialize();
  const test::TempFolder files;
  expectRefused(files.write("e.bullet", ""), "not a .bullet file", import);
  expectRefused(files.write("r.bullet", std::string(5000, 'x')), "not a .bullet file", import);
  expectRefused(files.write("h.bullet", whole.substr(0, 12)), "cut off", import);
  for (std::size_t length = 100; length + 100 < whole.size(); length += 1000)
    expectRefused(files.write("c.bullet", whole.substr(0, length)), "cut off", import);
}

// Each must end in a world or in a line: what chunks hold is tried in a child process.
TEST(ImportBullet, DamagedBytesDoNotCrashTheProgram) {
  Host host;
  const std::string whole = host.serialize();
  std::mt19937_64 random(11);
  const test::TempFolder files;
  int ended = 0;
  for (int i = 0; i < 60; ++i) {
    std::string bytes = whole;
    for (int k = 0; k < 8; ++k)
      bytes[12 + random() % (bytes.size() - 12)] = static_cast<char>(random() % 256);
    try {
      (void)import(files.write("d.bullet", bytes));
    } catch (const UsageError&) {
    }
    ++ended;
  }
  EXPECT_EQ(ended, 60);
}

}  // namespace
}  // namespace tandem::demos
