#include <cstddef>

#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_acts.h"
#include "bench/guest/guest_scalar.h"
#include "bench/guest/guest_world.h"

// Hosts do these things to multi-bodies. A world without arms is left as it is.

namespace tandem::demos::bench {
namespace {

constexpr double kMostTieForce = 500.0;  // [N]

/// An arm of the world, and one of its links.
struct Part {
  GuestArm* arm = nullptr;
  int link = 0;
  int dofs = 0;
};

Part drawPart(GuestWorld& world, Draw& draw) {
  if (world.arms().empty()) return {};
  Part part;
  const auto last = static_cast<int>(world.arms().size()) - 1;
  part.arm = world.arms()[static_cast<std::size_t>(draw.count(0, last))].get();
  part.link = draw.count(0, part.arm->body().getNumLinks() - 1);
  part.dofs = part.arm->body().getLink(part.link).m_dofCount;
  return part;
}

/// One of an arm's holds that a predicate takes; the number of all if there is none.
template <typename Takes>
std::size_t drawHold(const GuestArm& arm, Draw& draw, Takes takes) {
  std::vector<std::size_t> taken;
  for (std::size_t h = 0; h < arm.holds().size(); ++h)
    if (takes(arm.holds()[h])) taken.push_back(h);
  const int which = draw.count(0, 1000);
  return taken.empty() ? arm.holds().size() : taken[static_cast<std::size_t>(which) % taken.size()];
}

bool isMotor(const GuestArm::Hold& hold) {
  return hold.constraint->getConstraintType() == MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR;
}
bool isTie(const GuestArm::Hold& hold) { return hold.is_tie; }
bool isNoTie(const GuestArm::Hold& hold) { return !hold.is_tie; }

void setPosition(GuestWorld& world, Draw& draw) {
  const Part part = drawPart(world, draw);
  if (part.dofs != 1) return;
  part.arm->body().setJointPos(part.link, scalar(draw.even(-0.5, 0.5)));
  part.arm->showPose();
}

void setJointVelocity(GuestWorld& world, Draw& draw) {
  const Part part = drawPart(world, draw);
  for (int k = 0; k < part.dofs; ++k)
    part.arm->body().getJointVelMultiDof(part.link)[k] = scalar(draw.even(-1.0, 1.0));
}

void giveTorque(GuestWorld& world, Draw& draw) {
  const Part part = drawPart(world, draw);
  for (int k = 0; k < part.dofs; ++k) part.arm->addTorque(part.link, k, draw.even(-2.0, 2.0));
}

void giveForce(GuestWorld& world, Draw& draw) {
  const Part part = drawPart(world, draw);
  if (part.arm) part.arm->addForce(part.link, draw.even(0.0, 8.0) * draw.direction());
}

void setMotorTarget(GuestWorld& world, Draw& draw) {
  const Part part = drawPart(world, draw);
  if (!part.arm) return;
  const std::size_t which = drawHold(*part.arm, draw, isMotor);
  if (which == part.arm->holds().size()) return;
  auto& motor = static_cast<btMultiBodyJointMotor&>(*part.arm->holds()[which].constraint);
  if (draw.chance(0.5)) {
    motor.setVelocityTarget(scalar(draw.even(-2.0, 2.0)), draw.chance(0.5) ? 1 : btScalar(0.5));
  } else {
    motor.setPositionTarget(scalar(draw.even(-0.5, 0.5)), scalar(draw.even(0.0, 0.3)));
  }
}

void setStrength(GuestWorld& world, Draw& draw) {
  const Part part = drawPart(world, draw);
  if (!part.arm) return;
  const bool is_tie = draw.chance(0.5);
  const std::size_t which = drawHold(*part.arm, draw, is_tie ? isTie : isMotor);
  const double force = draw.log(0.1, is_tie ? kMostTieForce : 20.0);
  if (which == part.arm->holds().size()) return;
  part.arm->holds()[which].constraint->setMaxAppliedImpulse(scalar(force * world.plan().step()));
}

void addMotor(GuestWorld& world, Draw& draw) {
  const Part part = drawPart(world, draw);
  if (part.arm) part.arm->addMotor(part.link, draw);
}

void addLimit(GuestWorld& world, Draw& draw) {
  const Part part = drawPart(world, draw);
  if (part.arm) part.arm->addLimit(part.link, draw);
}

void addTie(GuestWorld& world, Draw& draw) { world.addTie(draw); }

void removeOne(GuestWorld& world, Draw& draw, bool (*takes)(const GuestArm::Hold&)) {
  const Part part = drawPart(world, draw);
  if (!part.arm) return;
  const std::size_t which = drawHold(*part.arm, draw, takes);
  if (which < part.arm->holds().size()) part.arm->removeHold(which);
}

void moveTie(GuestWorld& world, Draw& draw) {
  const Part part = drawPart(world, draw);
  if (!part.arm) return;
  const std::size_t which = drawHold(*part.arm, draw, isTie);
  const Vec3 p = 0.05 * draw.direction();
  if (which == part.arm->holds().size()) return;
  const GuestArm::Hold& tie = part.arm->holds()[which];
  // Places of the world are above the floor.
  const bool is_world = !tie.body && !tie.constraint->getMultiBodyB();
  tie.constraint->setPivotInB(toBullet(Vec3(p + (is_world ? 0.3 : 0.0) * Vec3::UnitZ())));
}

void setArmDamping(GuestWorld& world, Draw& draw) {
  const Part part = drawPart(world, draw);
  if (!part.arm) return;
  part.arm->body().setLinearDamping(scalar(draw.even(0.0, 0.1)));
  part.arm->body().setAngularDamping(scalar(draw.even(0.0, 0.1)));
}

void setBaseVelocity(GuestWorld& world, Draw& draw) {
  const Part part = drawPart(world, draw);
  if (!part.arm || part.arm->body().hasFixedBase()) return;
  part.arm->body().setBaseVel(toBullet(Vec3(draw.even(0.0, 0.5) * draw.direction())));
  part.arm->body().setBaseOmega(toBullet(Vec3(draw.even(0.0, 3.0) * draw.direction())));
}

void toggleArm(GuestWorld& world, Draw& draw) {
  const Part part = drawPart(world, draw);
  if (part.arm) world.toggleArm(*part.arm);
}

}  // namespace

void appendArmActs(std::vector<GuestAct>& acts) {
  acts.insert(acts.end(), {{"position of an arm's joint", false, setPosition},
                           {"velocity of an arm's joint", false, setJointVelocity},
                           {"torque on an arm's joint", true, giveTorque},
                           {"force on a link", true, giveForce},
                           {"target of an arm's motor", true, setMotorTarget},
                           {"strength of an arm's motor or tie", false, setStrength},
                           {"arm's motor added", false, addMotor},
                           {"arm's limit added", false, addLimit},
                           {"arm's motor or limit removed", false,
                            [](GuestWorld& world, Draw& draw) { removeOne(world, draw, isNoTie); }},
                           {"tie added", false, addTie},
                           {"tie removed", false,
                            [](GuestWorld& world, Draw& draw) { removeOne(world, draw, isTie); }},
                           {"pivot of a tie", false, moveTie},
                           {"damping of an arm", false, setArmDamping},
                           {"velocity of an arm's base", false, setBaseVelocity},
                           {"arm away or back", false, toggleArm}});
}

}  // namespace tandem::demos::bench
