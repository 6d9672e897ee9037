#include "joints/joint_graph.h"

#include <cmath>
#include <functional>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "bodies/body_look.h"
#include "joints/joint_copy.h"
#include "joints/moved_frames.h"
#include "world/world_access.h"
#include "world/world_lookup.h"

namespace tandem {
namespace {

/// A joint is open beyond this way, with a part of the smaller body's radius, or angle [m], [rad].
constexpr double kOpenWay = 1e-3, kOpenPart = 0.1, kOpenAngle = 0.1;

/// Calls `visit` for all joints of rigid bodies that act.
template <typename Visit>
void forEachJoint(btDiscreteDynamicsWorld& world, Visit visit) {
  for (int i = 0; i < world.getNumConstraints(); ++i)
    if (btTypedConstraint* joint = world.getConstraint(i); joint->isEnabled()) visit(*joint);
}

bool doesEndChain(const btRigidBody& body) { return !isDynamic(body); }

}  // namespace

template <typename Visit>
void JointGraph::forEachPair(const std::vector<ArmTie>& ties, Visit visit) const {
  forEachJoint(host_, [&](btTypedConstraint& joint) {
    visit(Jointed{&joint.getRigidBodyA()}, Jointed{&joint.getRigidBodyB()});
  });
  for (const ArmTie& tie : ties) visit(tie.a, tie.b);
}

void JointGraph::list(const std::vector<ArmTie>& ties) {
  listNodes(ties);
  nameChains(ties);
  listMembers(ties);
}

void JointGraph::listNodes(const std::vector<ArmTie>& ties) {
  nodes_.clear();
  int arms = host_.getNumCollisionObjects();  // they come last, in the order of their ties
  const auto add = [&](const Jointed& of) {
    if (of.body)
      nodes_.push_back({of, of.body->getWorldArrayIndex(), doesEndChain(*of.body)});
    else
      nodes_.push_back({of, arms++});
  };
  forEachPair(ties, [&](const Jointed& a, const Jointed& b) {
    add(a);
    add(b);
  });
  std::sort(nodes_.begin(), nodes_.end(), [](const Node& a, const Node& b) {
    const void *at_a = a.of.address(), *at_b = b.of.address();
    return at_a == at_b ? a.order < b.order : std::less<const void*>()(at_a, at_b);
  });
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end(),
                           [](const Node& a, const Node& b) { return a.of == b.of; }),
               nodes_.end());
}

/// Joins what each joint connects, and gives each set a number.
void JointGraph::nameChains(const std::vector<ArmTie>& ties) {
  parent_.resize(nodes_.size());
  for (std::size_t i = 0; i < parent_.size(); ++i) parent_[i] = i;
  const auto root = [&](std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  };
  const auto placeOf = [&](const Jointed& of) {
    return static_cast<std::size_t>(find(of.address()) - nodes_.data());
  };
  forEachPair(ties, [&](const Jointed& of_a, const Jointed& of_b) {
    const std::size_t a = placeOf(of_a), b = placeOf(of_b);
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
      if (const Node& node = *find(body); !node.is_end) chains_[node.chain].may_be_held = false;
  });
}

/// True if a body that may move is no longer in the world.
bool JointGraph::hasLeft(const btRigidBody& body) const {
  return !isFixed(body) && findInWorld(host_, &body, body.getWorldArrayIndex()) < 0;
}

/// True if its type is known, its frames stand, it is about closed, and its bodies are there.
bool JointGraph::mayBeHeld(btTypedConstraint& joint) {
  if (!JointCopy::isKnown(joint) || (moved_ && moved_->isMoving(joint))) return false;
  const btRigidBody &a = joint.getRigidBodyA(), &b = joint.getRigidBodyB();
  if (hasLeft(a) || hasLeft(b)) return false;
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

void JointGraph::listMembers(const std::vector<ArmTie>& ties) {
  listed_.clear();
  for (const Node& node : nodes_)
    if (!node.is_end) listed_.push_back({node.chain, node.order, node.of});
  // A kinematic end may be that of several chains.
  forEachPair(ties, [&](const Jointed& of_a, const Jointed& of_b) {
    const Node &a = *find(of_a.address()), &b = *find(of_b.address());
    if (a.is_end == b.is_end) return;
    const Node& end = a.is_end ? a : b;
    if (end.of.body->isKinematicObject())
      listed_.push_back({(a.is_end ? b : a).chain, end.order, end.of});
  });
  std::sort(listed_.begin(), listed_.end(), [](const Listed& a, const Listed& b) {
    return a.chain != b.chain ? a.chain < b.chain : a.order < b.order;
  });
  listed_.erase(std::unique(listed_.begin(), listed_.end(),
                            [](const Listed& a, const Listed& b) {
                              return a.chain == b.chain && a.of == b.of;
                            }),
                listed_.end());
  members_.clear();
  for (const Listed& listed : listed_) {
    if (chains_[listed.chain].count++ == 0) chains_[listed.chain].first = members_.size();
    members_.push_back(listed.of);
  }
}

const JointGraph::Node* JointGraph::find(const void* address) const {
  const auto place = std::lower_bound(nodes_.begin(), nodes_.end(), address,
                                      [](const Node& node, const void* wanted) {
                                        return std::less<const void*>()(node.of.address(), wanted);
                                      });
  return place != nodes_.end() && place->of.address() == address ? &*place : nullptr;
}

}  // namespace tandem
