#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "tandem/coordination/types.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

/// Something of the island's that may push others: the box of space it fills, and its velocity.
struct NeighbourSeed {
  Vec3 low_W = Vec3::Zero(), high_W = Vec3::Zero();
  Vec3 v_W = Vec3::Zero();
};

/// Which moving bodies of a host's world the island should hold, because they may take part in
/// contact with the island's own before the host is asked again.
///
/// A body is a neighbour if its box is nearer to a seed's, or to that of another neighbour, than
///
///   D = 2 mm + 1/2 a T^2 + 1.5 |relative velocity| T,   a = 20 m/s^2
///
/// T being the time until the host is heard again at the latest; one that is held already stays up
/// to 1.5 D. So a whole chain of bodies is taken before any of it is touched. Nearest first, wave
/// by wave from the seeds, and no more than the capacity: the rest stays the host's, and pushes
/// back by the host's own contact.
///
/// Kinematic bodies are taken as well, of any shape but a plane; the chain ends at them. No
/// neighbours: static bodies, bodies of joints, dynamic ones of shapes neither convex nor compound,
/// bodies without contact response or with simulation disabled. For the thread that steps the
/// host's world.
class NeighbourSearch {
 public:
  /// `host` must outlive this object.
  NeighbourSearch(btDiscreteDynamicsWorld& host, std::size_t capacity);

  /// Set-up: a body that is the island's anyway.
  void exclude(const btRigidBody& body) {
    excluded_.insert(std::upper_bound(excluded_.begin(), excluded_.end(), &body), &body);
  }

  /// Once per host step; `horizon` is T [s]. What the host has taken out of its world is not among
  /// them. Valid until the next call.
  const std::vector<btRigidBody*>& find(const std::vector<NeighbourSeed>& seeds, double horizon);

  /// True if the host's world has a kinematic body that does not sleep. Looks at all objects.
  [[nodiscard]] bool isAnythingDriven() const;

 private:
  struct Candidate {
    btRigidBody* body;
    double gap;
  };

  void findAround(const NeighbourSeed& seed, double horizon);
  void takeNearest();
  void findJointed();
  [[nodiscard]] bool mayBeNeighbour(const btRigidBody& body) const;

  btDiscreteDynamicsWorld& host_;
  std::size_t capacity_;
  std::vector<const btRigidBody*> excluded_, jointed_;
  std::vector<btRigidBody*> held_, found_;
  std::vector<NeighbourSeed> wave_;
  std::vector<Candidate> candidates_;
};

}  // namespace tandem
#pragma GCC visibility pop
