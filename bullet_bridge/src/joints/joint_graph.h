#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "coordination/src/island/joint_source.h"

class btDiscreteDynamicsWorld;
class btRigidBody;
class btTypedConstraint;

namespace tandem {

/// Chains of moving bodies that joints of the host's world connect.
///
/// The island holds all of a chain or nothing: a joint is solved where both of its bodies are. A
/// joint that is far from closed stays Bullet's, until Bullet has closed it.
/// Chains end at static and kinematic bodies. For the thread that steps the host's world.
class JointGraph {
 public:
  explicit JointGraph(btDiscreteDynamicsWorld& host) : host_(host) {}

  /// Reads the world's joints. `may_hold(body)` tells whether the island could hold a moving body.
  template <typename MayHold>
  void look(MayHold may_hold) {
    list();
    for (Node& node : nodes_)
      if (!node.is_end && !may_hold(*node.body)) chains_[node.chain].may_be_held = false;
  }

  /// True if some joint acts on the body.
  [[nodiscard]] bool isJointed(const btRigidBody& body) const { return find(body) != nullptr; }
  /// True if the island could hold all of the body's chain.
  [[nodiscard]] bool mayHoldChainOf(const btRigidBody& body) const {
    const Node* node = find(body);
    return node && !node->is_end && chains_[node->chain].may_be_held;
  }
  /// Calls `visit(body)` for all of its chain, in a fixed order, and for the kinematic bodies at
  /// its ends.
  template <typename Visit>
  void visitChainOf(const btRigidBody& body, Visit visit) const {
    const Node* node = find(body);
    if (!node || node->is_end) return;
    const Chain& chain = chains_[node->chain];
    for (std::size_t i = chain.first; i < chain.first + chain.count; ++i) visit(*members_[i]);
  }

 private:
  struct Node {
    btRigidBody* body;
    bool is_end = false;    ///< forces do not move it
    std::size_t chain = 0;  ///< of a moving body
  };
  struct Chain {
    bool may_be_held = true;
    std::size_t first = 0, count = 0;  ///< in members_
  };

  void list();
  void nameChains();
  void listMembers();
  [[nodiscard]] bool mayBeHeld(btTypedConstraint& joint);
  [[nodiscard]] const Node* find(const btRigidBody& body) const;

  btDiscreteDynamicsWorld& host_;
  std::vector<Node> nodes_;  ///< sorted by address
  std::vector<Chain> chains_;
  std::vector<btRigidBody*> members_;                         ///< chain by chain
  std::vector<std::pair<std::size_t, btRigidBody*>> listed_;  ///< working memory of listMembers()
  std::vector<std::size_t> parent_;                           ///< by node, for list()
  std::vector<JointRow> rows_;                                ///< working memory of mayBeHeld()
};

}  // namespace tandem
