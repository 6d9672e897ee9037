#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

class ConvexPolyhedron;

/// Convex solids made lately. A shape that comes back, or that several bodies have, is made once.
///
/// A solid is found by its points themselves, not by the shape's address: a host may change a
/// shape, or delete it and make another there. Comparing 4000 points takes some microseconds.
///
/// Thread safe: worlds of several threads share it. Locks and allocates; not for the tick.
class HullCache {
 public:
  /// Most points of all solids that are kept; those unused for longest go first. About 30 MB.
  static constexpr std::size_t kMostPoints = 50000;
  /// Solids of fewer points are made anew, which takes less than 0.05 ms.
  static constexpr std::size_t kFewPoints = 32;

  /// The cache of this process.
  [[nodiscard]] static HullCache& ofProcess();

  /// Convex hull of the points; null if they have no volume or are not finite.
  [[nodiscard]] static std::shared_ptr<const ConvexPolyhedron> make(
      const std::vector<Vec3>& points);
  /// The same, kept: the solid is shared by all who asked for these points.
  [[nodiscard]] std::shared_ptr<const ConvexPolyhedron> find(const std::vector<Vec3>& points);

  /// Solids that find() had to make.
  [[nodiscard]] std::uint64_t countMade() const;
  /// Points of all solids that are kept.
  [[nodiscard]] std::size_t countPoints() const;

 private:
  struct Entry {
    std::uint64_t hash;
    std::vector<Vec3> points;
    std::shared_ptr<const ConvexPolyhedron> solid;
    std::uint64_t last_use;
  };

  [[nodiscard]] Entry* findEntry(std::uint64_t hash, const std::vector<Vec3>& points);
  void makeRoom(std::size_t points);

  mutable std::mutex mutex_;
  std::vector<Entry> entries_;
  std::size_t points_ = 0;
  std::uint64_t uses_ = 0, made_ = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
