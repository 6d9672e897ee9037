#include "shapes/hull_cache.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "coordination/src/geometry/convex_polyhedron.h"

namespace tandem {
namespace {

/// FNV-1a over words.
std::uint64_t hashOf(const std::vector<Vec3>& points) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const Vec3& p : points) {
    for (int i = 0; i < 3; ++i) {
      std::uint64_t word = 0;
      std::memcpy(&word, &p[i], sizeof word);
      hash = (hash ^ word) * 1099511628211ULL;
      hash ^= hash >> 32;
    }
  }
  return hash;
}

/// Equal to the bit, so that NaN equals itself and 0 does not equal -0.
bool isSame(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  const auto is_same = [](const Vec3& p, const Vec3& q) {
    return std::memcmp(p.data(), q.data(), 3 * sizeof(double)) == 0;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same);
}

}  // namespace

HullCache& HullCache::ofProcess() {
  static HullCache cache;
  return cache;
}

std::shared_ptr<const ConvexPolyhedron> HullCache::make(const std::vector<Vec3>& points) {
  try {
    return std::make_shared<const ConvexPolyhedron>(ConvexPolyhedron::makeHull(points));
  } catch (const std::invalid_argument&) {
    return nullptr;  // a point, a line or a plate
  }
}

std::shared_ptr<const ConvexPolyhedron> HullCache::find(const std::vector<Vec3>& points) {
  const bool is_kept = points.size() >= kFewPoints && points.size() <= kMostPoints;
  const std::uint64_t hash = is_kept ? hashOf(points) : 0;
  if (is_kept) {
    const std::lock_guard lock(mutex_);
    if (Entry* known = findEntry(hash, points)) {
      known->last_use = ++uses_;
      return known->solid;
    }
  }
  // Other threads do not wait meanwhile; two may make the same.
  std::shared_ptr<const ConvexPolyhedron> solid = make(points);
  const std::lock_guard lock(mutex_);
  ++made_;
  if (!is_kept || findEntry(hash, points)) return solid;
  makeRoom(points.size());
  points_ += points.size();
  entries_.push_back({hash, points, solid, ++uses_});
  return solid;
}

std::uint64_t HullCache::countMade() const {
  const std::lock_guard lock(mutex_);
  return made_;
}

std::size_t HullCache::countPoints() const {
  const std::lock_guard lock(mutex_);
  return points_;
}

HullCache::Entry* HullCache::findEntry(std::uint64_t hash, const std::vector<Vec3>& points) {
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.hash == hash && isSame(entry.points, points);
  });
  return known == entries_.end() ? nullptr : &*known;
}

/// Drops solids until so many more points fit in.
void HullCache::makeRoom(std::size_t points) {
  while (!entries_.empty() && points_ + points > kMostPoints) {
    const auto oldest =
        std::min_element(entries_.begin(), entries_.end(),
                         [](const Entry& a, const Entry& b) { return a.last_use < b.last_use; });
    points_ -= oldest->points.size();
    entries_.erase(oldest);
  }
}

}  // namespace tandem
