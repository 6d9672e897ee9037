#pragma once

#include <array>

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "surroundings/exact_part.h"

namespace tandem {

/// Contact points of one search, kept as features of two parts: a face of one, the *owner*, and
/// corners of the other. Gaps and positions follow from the poses in double, without a search,
/// while the parts have hardly moved relative to each other.
///
/// Real-time safe; one thread at a time.
class FrozenContact {
 public:
  /// A point of contact.
  struct Point {
    Vec3 p;           ///< middle between both parts, from the private origin [m]
    double distance;  ///< along the normal [m]
  };

  /// Takes the points that a search found at these poses. Their normals are those of `manifold`,
  /// from the second part to the first. False, and empty, if they are no corners on a face.
  bool freeze(const ExactPart& first, const ExactPart& second,
              const btPersistentManifold& manifold) noexcept;
  /// Computes the points at new poses. False if it is empty, or if others could touch now: a search
  /// is due.
  bool follow(const ExactPart& first, const ExactPart& second) noexcept;
  /// Forgets the points, and whose the face was.
  void drop() noexcept { count_ = 0, slide_ = 0.0, owner_ = Owner::kNone; }

  /// Points of the last freeze() or follow(), in the order of the search.
  [[nodiscard]] const Point* begin() const noexcept { return points_.data(); }
  [[nodiscard]] const Point* end() const noexcept { return points_.data() + count_; }
  /// Way along the face since the search, at the last follow() [m].
  [[nodiscard]] double slide() const noexcept { return slide_; }
  /// From the second part to the first.
  [[nodiscard]] const Vec3& normal() const noexcept { return normal_; }

 private:
  enum class Owner { kNone, kFirst, kSecond };
  /// A corner of the other part, or of the face on it, or where edges of both cross.
  struct Corner {
    Vec3 p = Vec3::Zero();  ///< in the other's frame; free coordinates follow from the owner's
    Vec3 at_search = Vec3::Zero();  ///< in the owner's frame
    bool is_of_other = true;        ///< a corner of the other part
    int free_count = 0;             ///< coordinates of the other's that are free
    std::array<int, 2> free{};      ///< their axes
    std::array<int, 2> held{};      ///< the owner's axes whose coordinates stay instead
  };

  [[nodiscard]] bool chooseOwner(Owner last, const ExactPart& first, const ExactPart& second,
                                 const btPersistentManifold& manifold) noexcept;
  [[nodiscard]] bool takeOwner(Owner owner, const ExactPart& first, const ExactPart& second,
                               const btPersistentManifold& manifold) noexcept;
  [[nodiscard]] bool takeCorner(const ExactPart& owner, const ExactPart& other, const Vec3& p,
                                Corner& corner) const noexcept;
  void takeCrossing(const ExactPart& owner, const ExactPart& other, const Vec3& p,
                    Corner& corner) const noexcept;
  [[nodiscard]] bool hasWholeFace() const noexcept;
  [[nodiscard]] bool findBounds(const ExactPart& owner, const ExactPart& other) noexcept;
  [[nodiscard]] static Vec3 locate(const Corner& corner, const Eigen::Matrix3d& in_owner,
                                   const Vec3& p_in_owner) noexcept;
  [[nodiscard]] bool place(const ExactPart& owner, const ExactPart& other) noexcept;

  std::array<Corner, MANIFOLD_CACHE_SIZE> corners_;
  std::array<Point, MANIFOLD_CACHE_SIZE> points_;
  int count_ = 0;
  double slide_ = 0.0;
  Owner owner_ = Owner::kNone;
  ExactFace face_;
  Vec3 face_half_ = Vec3::Zero();     ///< half extents of the owner; infinite: a plane [m]
  double rounding_ = 0.0;             ///< radius around the corners [m]
  Vec3 up_at_search_ = Vec3::Zero();  ///< the face's normal in the other's frame
  Vec3 normal_ = Vec3::Zero();
  double most_approach_ = 0.0, most_slide_ = 0.0;  ///< bounds of ways since the search [m]
  double most_sinking_ = 0.0;  ///< bound of the way by which a tilt moves others [m]
  double reach_ = 0.0;         ///< farthest that a point left out is from one that is not [m]
};

}  // namespace tandem
