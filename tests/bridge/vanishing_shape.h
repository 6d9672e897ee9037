#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include <BulletCollision/CollisionShapes/btConvexPointCloudShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletDynamicsCommon.h>

namespace tandem::test {

/// Classes of Bullet's shapes that own or refer to memory of their host.
enum class Vanishing {
  kMesh,
  kScaledMesh,
  kGImpact,
  kHeightField,
  kCompound,
  kNested,
  kHull,
  kCloud
};
inline constexpr int kVanishingKinds = 8;

/// A floor of any class, 0.4 m wide with its top at y = 0, with all memory that it refers to.
/// Dies as a host lets it: memory first overwritten, then freed.
class VanishingFloor {
 public:
  explicit VanishingFloor(Vanishing kind) {
    switch (kind) {
      case Vanishing::kMesh:
        shape_ = keep<btBvhTriangleMeshShape>(mesh(), true);
        break;
      case Vanishing::kScaledMesh:
        shape_ = keep<btScaledBvhTriangleMeshShape>(keep<btBvhTriangleMeshShape>(mesh(), true),
                                                    btVector3(1, 2, 1));
        break;
      case Vanishing::kGImpact: {
        auto* gimpact = keep<btGImpactMeshShape>(mesh());
        gimpact->updateBound();
        shape_ = gimpact;
        break;
      }
      case Vanishing::kHeightField:
        heights_.assign(9 * 9, btScalar(0));
        shape_ = keep<btHeightfieldTerrainShape>(9, 9, heights_.data(), btScalar(-1), btScalar(1),
                                                 1, false);
        shape_->setLocalScaling(btVector3(btScalar(0.05), 1, btScalar(0.05)));
        break;
      case Vanishing::kCompound:
        shape_ = makeCompound(keep<btBoxShape>(half()), keep<btBoxShape>(half()));
        break;
      case Vanishing::kNested:
        shape_ = makeCompound(makeCompound(keep<btBoxShape>(half()), makeHull()),
                              keep<btBoxShape>(half()));
        break;
      case Vanishing::kHull:
        shape_ = makeHull();
        break;
      case Vanishing::kCloud:
        fillCorners();
        shape_ = keep<btConvexPointCloudShape>(corners_.data(), 8, btVector3(1, 1, 1));
        shape_->setMargin(0);
        break;
    }
  }
  ~VanishingFloor() {
    spoil();
    while (!kept_.empty()) kept_.pop_back();
  }
  VanishingFloor(const VanishingFloor&) = delete;
  VanishingFloor& operator=(const VanishingFloor&) = delete;

  [[nodiscard]] btCollisionShape& shape() const { return *shape_; }

  /// Overwrites what the shapes refer to.
  void spoil() {
    const btScalar nowhere = std::numeric_limits<btScalar>::quiet_NaN();
    std::fill(corners_.begin(), corners_.end(), btVector3(nowhere, nowhere, nowhere));
    std::fill(heights_.begin(), heights_.end(), nowhere);
  }

 private:
  static btVector3 half() { return {btScalar(0.2), btScalar(0.05), btScalar(0.2)}; }

  template <typename ShapeType, typename... Arguments>
  ShapeType* keep(Arguments... arguments) {
    auto shape = std::make_unique<ShapeType>(arguments...);
    ShapeType* raw = shape.get();
    kept_.push_back(std::move(shape));
    return raw;
  }

  btStridingMeshInterface* mesh() {
    const btScalar edge = btScalar(0.2);
    corners_ = {{-edge, 0, -edge}, {-edge, 0, edge}, {edge, 0, edge}, {edge, 0, -edge}};
    indices_ = {0, 1, 2, 0, 2, 3};
    mesh_ = std::make_unique<btTriangleIndexVertexArray>(
        2, indices_.data(), 3 * static_cast<int>(sizeof(int)), 4, &corners_[0][0],
        static_cast<int>(sizeof(btVector3)));
    return mesh_.get();
  }

  void fillCorners() {
    corners_.clear();
    for (int i = 0; i < 8; ++i)
      corners_.push_back(btVector3(i & 1 ? 1 : -1, i & 2 ? 0 : btScalar(-0.5), i & 4 ? 1 : -1) *
                         btScalar(0.2));
  }

  btCollisionShape* makeHull() {
    fillCorners();
    auto* hull = keep<btConvexHullShape>(&corners_[0][0], 8, static_cast<int>(sizeof(btVector3)));
    hull->setMargin(0);
    return hull;
  }

  /// The first is at the top, the second beside it.
  btCompoundShape* makeCompound(btCollisionShape* first, btCollisionShape* second) {
    auto* compound = keep<btCompoundShape>();
    btTransform pose(btQuaternion::getIdentity(), btVector3(0, btScalar(-0.05), 0));
    if (first->isCompound()) pose.setIdentity();
    compound->addChildShape(pose, first);
    pose.setOrigin(btVector3(btScalar(0.5), btScalar(-0.05), 0));
    compound->addChildShape(pose, second);
    return compound;
  }

  std::vector<btVector3> corners_;
  std::vector<int> indices_;
  std::vector<btScalar> heights_;
  std::unique_ptr<btStridingMeshInterface> mesh_;
  std::vector<std::unique_ptr<btCollisionShape>> kept_;
  btCollisionShape* shape_ = nullptr;
};

}  // namespace tandem::test
