#include "surroundings/triangle_run.h"

#include <algorithm>

#include <BulletCollision/CollisionShapes/btTriangleCallback.h>

namespace tandem {
namespace {

/// A region grows while it has fewer triangles than this.
constexpr std::size_t kFew = 512;
/// A larger copy than this is made only if the region asks for it.
constexpr std::size_t kMany = 4096;
constexpr int kMostWidenings = 8;
constexpr btScalar kAll = btScalar(BT_LARGE_FLOAT);

Region boundsOf(const btVector3* corners, std::size_t count) {
  Region box{corners[0], corners[0]};
  for (std::size_t i = 1; i < count; ++i) {
    box.low.setMin(corners[i]);
    box.high.setMax(corners[i]);
  }
  return box;
}

Region join(const Region& a, const Region& b) {
  Region both = a;
  both.low.setMin(b.low);
  both.high.setMax(b.high);
  return both;
}

class Gatherer final : public btTriangleCallback {
 public:
  Gatherer(const Region& region, std::vector<TriangleRun::Triangle>& triangles, std::size_t most)
      : region_(region), triangles_(triangles), most_(most) {}
  void processTriangle(btVector3* corners, int, int) override {
    if (triangles_.size() > most_ || !overlap(boundsOf(corners, 3), region_)) return;
    triangles_.push_back({{corners[0], corners[1], corners[2]}});
  }

 private:
  const Region& region_;
  std::vector<TriangleRun::Triangle>& triangles_;
  std::size_t most_;
};

void collect(const btConcaveShape& shape, const Region& region, std::size_t most,
             std::vector<TriangleRun::Triangle>& triangles) {
  triangles.clear();
  Gatherer gatherer(region, triangles, most);
  shape.processAllTriangles(&gatherer, region.low, region.high);
}

}  // namespace

void TriangleRun::gather(const btConcaveShape& shape, const Region& region) {
  const Region whole = computeRegion(shape, btTransform::getIdentity());
  gathered_ = region;
  collect(shape, gathered_, static_cast<std::size_t>(-1), triangles_);
  std::vector<Triangle> more;
  for (int i = 0; i < kMostWidenings && triangles_.size() < kFew && !contains(gathered_, whole);
       ++i) {
    const Region wider = growRegion(gathered_, (gathered_.high - gathered_.low).length());
    collect(shape, wider, kMany, more);
    if (more.size() > kMany) break;
    triangles_.swap(more);
    gathered_ = wider;
  }
  if (contains(gathered_, whole)) gathered_ = {-btVector3(kAll, kAll, kAll), {kAll, kAll, kAll}};
  fillBoxes();
  close_.clear();
  close_.reserve(triangles_.size());
}

void TriangleRun::fillBoxes() {
  const auto fill = [](std::size_t count, std::vector<Region>& boxes, auto box_of) {
    boxes.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const Region box = box_of(i);
      if (i % kInBox == 0) {
        boxes.push_back(box);
      } else {
        boxes.back() = join(boxes.back(), box);
      }
    }
  };
  fill(triangles_.size(), boxes_,
       [&](std::size_t i) { return boundsOf(triangles_[i].corners, 3); });
  fill(boxes_.size(), large_boxes_, [&](std::size_t i) { return boxes_[i]; });
}

void TriangleRun::look(const Region& region) noexcept {
  close_.clear();
  const auto end_of = [](std::size_t place, std::size_t count) {
    return std::min((place + 1) * kInBox, count);
  };
  for (std::size_t large = 0; large < large_boxes_.size(); ++large) {
    if (!overlap(large_boxes_[large], region)) continue;
    for (std::size_t box = large * kInBox; box < end_of(large, boxes_.size()); ++box) {
      if (!overlap(boxes_[box], region)) continue;
      for (std::size_t i = box * kInBox; i < end_of(box, triangles_.size()); ++i)
        if (overlap(boundsOf(triangles_[i].corners, 3), region))
          close_.push_back(static_cast<int>(i));
    }
  }
}

}  // namespace tandem
