#pragma once

#include <memory>
#include <vector>

#include "coordination/src/island/contact_finder.h"
#include "surroundings/frozen_contact.h"
#include "surroundings/private_copies.h"
#include "surroundings/quiet_contact.h"
#include "surroundings/triangle_run.h"

namespace tandem {

/// Surface properties of a pair, combined by Bullet's functions or the host's.
struct Material {
  double friction = 0.0, restitution = 0.0, rolling = 0.0, spinning = 0.0;

  /// In the host's thread.
  [[nodiscard]] static Material of(const btCollisionObject& a, const btCollisionObject& b);
  [[nodiscard]] bool operator==(const Material&) const noexcept = default;
};

/// Region of a mesh's frame that a box may reach, grown by `margin`. `pose`: of the mesh's object.
[[nodiscard]] Region findRegionInMesh(const Part& mesh, const btTransform& pose, const Region& box,
                                      btScalar margin) noexcept;

/// Triangles of a mesh near the other copy of its pair.
struct NearTriangles {
  const Part* mesh;
  bool is_of_a;
  TriangleRun run;
};

/// Contact of two private copies: Bullet's narrowphase on each two of their parts that are near.
///
/// The host's thread makes it and fills its meshes. Then it belongs to the thread that ticks.
class ContactPair {
 public:
  /// Shared by the parts of all pairs while one is searched.
  struct WorkSpace {
    explicit WorkSpace(QuietDispatcher& its_dispatcher) : dispatcher(its_dispatcher) {}
    QuietDispatcher& dispatcher;
    btDispatcherInfo dispatch;
    btPersistentManifold decoy;  ///< stays empty: quiet_contact.h
    std::vector<RigidContact>* contacts = nullptr;
    Vec3 origin_W = Vec3::Zero();
    double min_bounce_speed = 0.0;
  };

  ContactPair(PrivateCopy& copy_a, PrivateCopy& copy_b, const Material& its_material)
      : a(&copy_a), b(&copy_b), material(its_material) {}

  /// Each two parts that may touch become a part pair, and each mesh gets room. Allocates.
  void fill();
  /// Goes on with the contact of another pair of the same copies. Real-time safe.
  void goOnWith(ContactPair& other) noexcept;

  /// @name Real-time safe.
  /// @{
  [[nodiscard]] bool overlaps(const Region& a, const Region& b) const noexcept;
  /// Chooses the parts and triangles that may touch while the copies move by `reach` [m] in all.
  void lookCloser(WorkSpace& work, btScalar reach) noexcept;
  /// Reports the contact. True if Bullet was asked; else frozen contact answered for all parts.
  bool search(WorkSpace& work) noexcept;
  /// Gives back what Bullet keeps for contact.
  void release(QuietDispatcher& dispatcher) noexcept;
  /// @}

  PrivateCopy* a;
  PrivateCopy* b;
  Material material;
  std::vector<NearTriangles> meshes;  ///< of a, then of b
  bool near = false;

 private:
  /// Bullet's order of the two: a mesh or plane is second, a compound first.
  struct PartPair {
    const Part* first;
    const Part* second;
    bool is_swapped;     ///< the first is of b
    int mesh = -1;       ///< index in meshes, if the second is one
    bool close = false;  ///< in the last lookCloser()
    btCollisionAlgorithm* algorithm = nullptr;
    btPersistentManifold* kept = nullptr;
    FrozenContact frozen{};  ///< of `kept`
  };

  [[nodiscard]] bool isSingle() const noexcept { return !a->is_compound && !b->is_compound; }
  void addPartPair(const Part& of_a, const Part& of_b);
  [[nodiscard]] btScalar breakingThreshold() const noexcept;
  bool searchPart(PartPair& pair, WorkSpace& work) noexcept;
  void searchTriangles(PartPair& pair, const btTransform& first_pose,
                       const btTransform& second_pose, WorkSpace& work) noexcept;
  void slideAlong(btPersistentManifold& manifold, bool is_swapped) noexcept;
  void report(const PartPair& pair, WorkSpace& work) const noexcept;
  void reportFrozen(const PartPair& pair, WorkSpace& work) const noexcept;
  void report(const Vec3& p_W, const Vec3& n_W, double distance, WorkSpace& work) const noexcept;
  static void release(PartPair& pair, QuietDispatcher& dispatcher) noexcept;

  std::vector<PartPair> parts_;
};

}  // namespace tandem
