#include "joints/joint_graph.h"

#include <cmath>
#include <functional>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "joints/joint_copy.h"
#include "world/world_access.h"

namespace tandem {
namespace {

/// A joint is open beyond this way, with a part of the smaller body's radius, or angle [m], [rad].
constexpr double kOpenWay = 1e-3, kOpenPart = 0.1, kOpenAngle = 0.1;

/// Calls `visit` for all joints that act.
template <typename Visit>
void forEachJoint(btDiscreteDynamicsWorld& world, Visit visit) {
  for (int i = 0; i < world.getNumConstraints(); ++i)
    if (btTypedConstraint* joint = world.getConstraint(i); joint->isEnabled()) visit(*joint);
}

/// The host's order, which addresses do not keep from run to run.
bool comesBefore(const btRigidBody* a, const btRigidBody* b) {
  return a->getWorldArrayIndex() < b->getWorldArrayIndex();
}

}  // namespace

void JointGraph::list() {
  nodes_.clear();
  forEachJoint(host_, [&](btTypedConstraint& joint) {
    for (btRigidBody* body : {&joint.getRigidBodyA(), &joint.getRigidBodyB()})
      nodes_.push_back({body, body->isStaticOrKinematicObject() || body->getInvMass() == 0});
  });
  const auto isLess = [](const Node& a, const Node& b) {
    return std::less<const btRigidBody*>()(a.body, b.body);
  };
  std::sort(nodes_.begin(), nodes_.end(), isLess);
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end(),
                           [](const Node& a, const Node& b) { return a.body == b.body; }),
               nodes_.end());
  nameChains();
  listMembers();
}

/// Joins what each joint connects, and gives each set a number.
void JointGraph::nameChains() {
  parent_.resize(nodes_.size());
  for (std::size_t i = 0; i < parent_.size(); ++i) parent_[i] = i;
  const auto root = [&](std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  };
  const auto placeOf = [&](const btRigidBody& body) {
    return static_cast<std::size_t>(find(body) - nodes_.data());
  };
  forEachJoint(host_, [&](btTypedConstraint& joint) {
    const std::size_t a = placeOf(joint.getRigidBodyA()), b = placeOf(joint.getRigidBodyB());
    if (!nodes_[a].is_end && !nodes_[b].is_end) parent_[root(a)] = root(b);
  });
  chains_.clear();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].is_end || root(i) != i) continue;
    nodes_[i].chain = chains_.size();
    chains_.emplace_back();
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (!nodes_[i].is_end) nodes_[i].chain = nodes_[root(i)].chain;
  forEachJoint(host_, [&](btTypedConstraint& joint) {
    if (mayBeHeld(joint)) return;
    for (const btRigidBody* body : {&joint.getRigidBodyA(), &joint.getRigidBodyB()})
      if (const Node& node = *find(*body); !node.is_end) chains_[node.chain].may_be_held = false;
  });
}

/// True if its type is known, and it is about closed.
bool JointGraph::mayBeHeld(btTypedConstraint& joint) {
  if (!JointCopy::isKnown(joint)) return false;
  const btRigidBody &a = joint.getRigidBodyA(), &b = joint.getRigidBodyB();
  double size = HUGE_VAL;
  for (const btRigidBody* body : {&a, &b}) {
    if (body->getInvMass() == 0) continue;
    btVector3 middle;
    btScalar radius = 0;
    body->getCollisionShape()->getBoundingSphere(middle, radius);
    size = std::min(size, static_cast<double>(radius));
  }
  rows_.clear();
  JointCopy(joint, HostSolver()).evaluate(readState(a), readState(b), rows_);
  return std::all_of(rows_.begin(), rows_.end(), [&](const JointRow& row) {
    const bool is_rigid =
        row.law == JointLaw::kLocked && row.stiffness == 0.0 && row.damping == 0.0;
    const double most = row.n_W == Vec3::Zero() ? kOpenAngle : kOpenWay + kOpenPart * size;
    return !is_rigid || std::abs(row.way) < most;
  });
}

void JointGraph::listMembers() {
  listed_.clear();
  for (const Node& node : nodes_)
    if (!node.is_end) listed_.emplace_back(node.chain, node.body);
  // A kinematic end may be that of several chains.
  forEachJoint(host_, [&](btTypedConstraint& joint) {
    const Node &a = *find(joint.getRigidBodyA()), &b = *find(joint.getRigidBodyB());
    if (a.is_end == b.is_end) return;
    const Node& end = a.is_end ? a : b;
    if (end.body->isKinematicObject()) listed_.emplace_back((a.is_end ? b : a).chain, end.body);
  });
  std::sort(listed_.begin(), listed_.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : comesBefore(a.second, b.second);
  });
  listed_.erase(std::unique(listed_.begin(), listed_.end()), listed_.end());
  members_.clear();
  for (const auto& [chain, body] : listed_) {
    if (chains_[chain].count++ == 0) chains_[chain].first = members_.size();
    members_.push_back(body);
  }
}

const JointGraph::Node* JointGraph::find(const btRigidBody& body) const {
  const auto place = std::lower_bound(nodes_.begin(), nodes_.end(), &body,
                                      [](const Node& node, const btRigidBody* wanted) {
                                        return std::less<const btRigidBody*>()(node.body, wanted);
                                      });
  return place != nodes_.end() && place->body == &body ? &*place : nullptr;
}

}  // namespace tandem
