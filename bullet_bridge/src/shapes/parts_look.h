#pragma once

#include <cstdint>

#include "tandem/bullet_bridge/convert.h"

#include "coordination/src/fnv.h"
#include "shapes/compound_children.h"

namespace tandem {

/// A number that changes if a part of a compound comes, goes, moves or changes its size; 0 for a
/// shape that is no compound. A compound does not tell its owner of changes in its children.
[[nodiscard]] inline std::uint64_t lookAtParts(const btCollisionShape& shape) {
  if (!hasChildren(shape)) return 0;
  Fnv fnv;
  const auto add = [&](const btVector3& v) {
    for (int i = 0; i < 3; ++i) fnv.addWord(static_cast<double>(v[i]));
  };
  forEachLeaf(shape, btTransform::getIdentity(),
              [&](const btCollisionShape& part, const btTransform& pose) {
                fnv.addWord(std::uint64_t{reinterpret_cast<std::uintptr_t>(&part)});
                for (int i = 0; i < 3; ++i) add(pose.getBasis()[i]);
                add(pose.getOrigin());
                add(part.getLocalScaling());
                fnv.addWord(static_cast<double>(part.getMargin()));
                btVector3 low, high;
                part.getAabb(btTransform::getIdentity(), low, high);
                add(low);
                add(high);
              });
  return fnv.value();
}

}  // namespace tandem
