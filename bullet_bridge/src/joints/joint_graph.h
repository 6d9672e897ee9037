#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "coordination/src/island/joint_source.h"

class btDiscreteDynamicsWorld;
class btMultiBody;
class btRigidBody;
class btTypedConstraint;

namespace tandem {

class MovedFrames;

/// What joints connect: a rigid body, or a whole multi-body.
struct Jointed {
  btRigidBody* body = nullptr;
  btMultiBody* arm = nullptr;

  [[nodiscard]] const void* address() const noexcept {
    return body ? static_cast<const void*>(body) : arm;
  }
  [[nodiscard]] bool operator==(const Jointed&) const noexcept = default;
};

/// A constraint of a multi-body with something else.
struct ArmTie {
  Jointed a, b;
};

/// Chains of moving bodies that joints of the host's world connect.
///
/// The island holds all of a chain or nothing: a joint is solved where both of its bodies are. A
/// joint that is far from closed stays Bullet's, until Bullet has closed it. So does one whose
/// frames the host moves, and one of a body that the host has taken out of its world already.
/// Chains end at static and kinematic bodies. For the thread that steps the host's world.
class JointGraph {
 public:
  /// `moved`: joints whose frames move stay Bullet's; null: none do.
  JointGraph(btDiscreteDynamicsWorld& host, const MovedFrames* moved)
      : host_(host), moved_(moved) {}

  /// Reads the world's joints, and `ties` of its multi-bodies. `may_hold(body)` tells whether the
  /// island could hold a moving rigid body.
  template <typename MayHold>
  void look(const std::vector<ArmTie>& ties, MayHold may_hold) {
    list(ties);
    for (Node& node : nodes_)
      if (node.of.body && !node.is_end && !may_hold(*node.of.body))
        chains_[node.chain].may_be_held = false;
  }

  /// @name Of a rigid body or a multi-body.
  /// @{
  /// True if some joint acts on it.
  template <typename Body>
  [[nodiscard]] bool isJointed(const Body& body) const {
    return find(&body) != nullptr;
  }
  /// True if the island could hold all of its chain, but for multi-bodies.
  template <typename Body>
  [[nodiscard]] bool mayHoldChainOf(const Body& body) const {
    const Node* node = find(&body);
    return node && !node->is_end && chains_[node->chain].may_be_held;
  }
  /// Calls `visit(Jointed)` for all of its chain, in a fixed order, and for the kinematic bodies at
  /// its ends.
  template <typename Body, typename Visit>
  void visitChainOf(const Body& body, Visit visit) const {
    const Node* node = find(&body);
    if (!node || node->is_end) return;
    const Chain& chain = chains_[node->chain];
    for (std::size_t i = chain.first; i < chain.first + chain.count; ++i) visit(members_[i]);
  }
  /// @}

 private:
  struct Node {
    Jointed of;
    int order = 0;          ///< the host's, which addresses do not keep from run to run
    bool is_end = false;    ///< forces do not move it
    std::size_t chain = 0;  ///< of what moves
  };
  struct Chain {
    bool may_be_held = true;
    std::size_t first = 0, count = 0;  ///< in members_
  };
  /// A member of a chain, to be sorted.
  struct Listed {
    std::size_t chain;
    int order;
    Jointed of;
  };

  /// Calls `visit(a, b)` for all joints that act and all ties.
  template <typename Visit>
  void forEachPair(const std::vector<ArmTie>& ties, Visit visit) const;
  void list(const std::vector<ArmTie>& ties);
  void listNodes(const std::vector<ArmTie>& ties);
  void nameChains(const std::vector<ArmTie>& ties);
  void listMembers(const std::vector<ArmTie>& ties);
  [[nodiscard]] bool mayBeHeld(btTypedConstraint& joint);
  [[nodiscard]] bool hasLeft(const btRigidBody& body) const;
  [[nodiscard]] const Node* find(const void* address) const;

  btDiscreteDynamicsWorld& host_;
  const MovedFrames* moved_;
  std::vector<Node> nodes_;  ///< sorted by address
  std::vector<Chain> chains_;
  std::vector<Jointed> members_;     ///< chain by chain
  std::vector<Listed> listed_;       ///< working memory of listMembers()
  std::vector<std::size_t> parent_;  ///< by node, for list()
  std::vector<JointRow> rows_;       ///< working memory of mayBeHeld()
};

}  // namespace tandem
