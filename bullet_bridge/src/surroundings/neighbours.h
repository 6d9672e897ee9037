#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tandem/coordination/types.h"

#include "coordination/src/island/collision_filter.h"
#include "joints/joint_graph.h"

class btCollisionObject;
class btDiscreteDynamicsWorld;
class btMultiBody;
class btMultiBodyDynamicsWorld;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

/// Bounding box and velocity of an island body that may push others.
struct NeighbourSeed {
  Vec3 low_W = Vec3::Zero(), high_W = Vec3::Zero();
  Vec3 v_W = Vec3::Zero();
  std::optional<CollisionFilter> filter = {};  ///< of a haptic sphere, which may pass some bodies
};

/// Selects the moving bodies of a host's world that the island should hold. They may touch the
/// island's bodies before the host's next step.
///
/// A body is a neighbour if its box is nearer to a seed's, or to another neighbour's, than
///
///   D = 2 mm + 1/2 a T^2 + 1.5 |relative velocity| T,   a = 20 m/s^2
///
/// T is the longest time until the host's next step. A held body stays up to 1.5 D. A whole chain
/// of bodies is thus taken before any of it is touched. The search goes in waves from the seeds,
/// nearest first, up to the capacity. Further bodies stay the host's and push back by its own
/// contact.
///
/// Bodies in joints come with all of their chain, or not at all (JointGraph); so do the chains of
/// excluded bodies, and multi-bodies: each of their links that moves takes a place. Constraints of
/// multi-bodies with something else are joints of chains, too. Kinematic
/// bodies of any shape but a plane are taken too; the chain ends at them. Left out are static
/// bodies, and dynamic bodies of shapes neither convex nor compound. So are bodies without contact
/// response or with simulation disabled. For the thread that steps the host's world.
class NeighbourSearch {
 public:
  /// `host` and `moved` must outlive this object. Without `moved` no joint's frames move.
  NeighbourSearch(btDiscreteDynamicsWorld& host, std::size_t capacity, const MovedFrames* moved);
  NeighbourSearch(btDiscreteDynamicsWorld& host, std::size_t capacity);

  /// Excludes a body that the island holds anyway. Allocates.
  void exclude(const btRigidBody& body) {
    excluded_.insert(std::upper_bound(excluded_.begin(), excluded_.end(), &body), &body);
  }
  /// Ends the exclusion of a body, which may have been deleted.
  /// The body may have been deleted.
  void include(const btRigidBody* body) noexcept { std::erase(excluded_, body); }

  /// Once per host step; `horizon` is T [s]. Omits bodies that the host removed from its world. The
  /// result is valid until the next call.
  const std::vector<btRigidBody*>& find(const std::vector<NeighbourSeed>& seeds, double horizon);

  /// Multi-bodies that the last find() has found, to be held whole.
  [[nodiscard]] const std::vector<btMultiBody*>& arms() const noexcept { return found_arms_; }

  /// Adds a line for each multi-body that was near at the last find() and stays Bullet's.
  void explainArms(std::vector<std::string>& lines) const;

  /// True if a body that the last find() did not report has come near the seed: the next find()
  /// would report it. Joints are those of the last find().
  [[nodiscard]] bool isAnythingComing(const NeighbourSeed& seed, double horizon) const;

  /// True if joints of an excluded body are left to Bullet: at the last find() the island could not
  /// hold all of its chain.
  [[nodiscard]] bool leavesJointsOf(const btRigidBody& body) const;

  /// True if a stranger may touch `body` within `horizon` [s]: a moving object, with contact
  /// response, that is neither excluded nor found.
  [[nodiscard]] bool isStrangerNear(const btRigidBody& body, double horizon) const;

  /// True if the host's world has an awake kinematic body. Checks all objects.
  [[nodiscard]] bool isAnythingDriven() const;

 private:
  /// A rigid body, or a link's collider.
  struct Candidate {
    btCollisionObject* object;
    double gap;
  };
  /// A multi-body of the host's world.
  struct Arm {
    btMultiBody* body;
    std::size_t places = 0;               ///< that it takes; 0: the island cannot hold it
    bool moves = true;                    ///< false: all of it is fixed
    bool is_near = false;                 ///< not only what it is in joints with
    const char* why_not = nullptr;        ///< it cannot be held; null: it has too many links
    std::vector<RigidState> states = {};  ///< of base and links
  };

  template <typename Take>
  void visitNear(const NeighbourSeed& seed, double horizon, Take take) const;
  void findAround(const NeighbourSeed& seed, double horizon);
  void listTies();
  /// Nothing for what is in no joints.
  template <typename Visit>
  void visitChainOf(const Jointed& of, Visit visit) const;
  void takeNearest();
  void takeWithChain(const Jointed& of);
  void take(const Jointed& of);
  void takeBody(btRigidBody& body);
  void takeArm(const Arm& arm);
  [[nodiscard]] bool isTaken(const Jointed& of) const;
  [[nodiscard]] bool hasRoomFor(const Jointed& of) const;
  [[nodiscard]] std::size_t countPlaces(const Jointed& of) const;
  [[nodiscard]] bool mayHoldChainOf(const Jointed& of) const;
  [[nodiscard]] Arm& lookUpArm(btMultiBody& body) const;
  [[nodiscard]] Arm readArm(btMultiBody& body) const;
  [[nodiscard]] const Arm* findArm(const btCollisionObject& object) const;
  [[nodiscard]] RigidState readVelocities(const btCollisionObject& object) const;
  [[nodiscard]] bool isFound(const btCollisionObject& object) const;
  [[nodiscard]] bool wasHeld(const btCollisionObject& object) const;
  void takeChainsOfExcluded();
  [[nodiscard]] bool isExcluded(const btRigidBody& body) const;
  [[nodiscard]] bool mayBeHeld(const btRigidBody& body) const;
  [[nodiscard]] bool mayBeNeighbour(const btRigidBody& body) const;
  [[nodiscard]] bool mayBeFound(const btCollisionObject& object) const;
  [[nodiscard]] bool isStranger(const btCollisionObject& object) const;

  btDiscreteDynamicsWorld& host_;
  btMultiBodyDynamicsWorld* arms_host_;  ///< the same; null: it can have no multi-bodies
  std::size_t capacity_;
  JointGraph joints_;
  std::vector<ArmTie> ties_;
  std::vector<const btRigidBody*> excluded_;
  std::vector<btRigidBody*> held_, found_;
  mutable std::vector<Arm> arms_;  ///< that came near since the last find() began
  std::vector<btMultiBody*> held_arms_, found_arms_;
  std::size_t taken_ = 0;  ///< places of all that is found
  std::vector<NeighbourSeed> wave_;
  std::vector<Candidate> candidates_;
};

}  // namespace tandem
#pragma GCC visibility pop
