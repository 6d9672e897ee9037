#include "gl/solid_batches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace tandem::view {
namespace {

// A body that has left the world casts no shadow, since one picture of the sun must hold them all.
constexpr double kNear = 20.0;  // [eye distances]

// The inverse of sRGB's curve.
float toLinear(float part) {
  if (!(part > 0.04045F)) return std::fmax(part, 0.0F) / 12.92F;
  return std::pow((part + 0.055F) / 1.055F, 2.4F);
}

SolidInstance makeInstance(const Solid& solid) {
  const Eigen::Vector3f p = solid.p_WB.cast<float>();
  const Eigen::Quaternionf q = solid.q_WB.normalized().cast<float>();
  return {.origin = {p.x(), p.y(), p.z()},
          .turn = {q.x(), q.y(), q.z(), q.w()},
          .colour = {toLinear(solid.colour.red), toLinear(solid.colour.green),
                     toLinear(solid.colour.blue)}};
}

bool isDrawable(const Solid& solid) {
  return solid.mesh != nullptr && !solid.mesh->indices.empty() && solid.p_WB.allFinite() &&
         solid.q_WB.coeffs().allFinite() && solid.q_WB.norm() > 0.0;
}

// What is hidden costs less if it is drawn after what hides it.
void sortFromEye(std::vector<SolidInstance>& instances, const Vec3& p_WEye) {
  const Eigen::Vector3f eye = p_WEye.cast<float>();
  const auto distance = [&eye](const SolidInstance& instance) {
    return (Eigen::Map<const Eigen::Vector3f>(instance.origin) - eye).squaredNorm();
  };
  std::stable_sort(instances.begin(), instances.end(),
                   [&distance](const SolidInstance& a, const SolidInstance& b) {
                     return distance(a) < distance(b);
                   });
}

}  // namespace

SolidBatches groupSolids(const DrawList& list, const Eye& eye, MeshStore& store) {
  SolidBatches grouped;
  const Vec3 p_WEye = computeEyePosition(eye);
  std::map<std::pair<const StoredMesh*, bool>, std::size_t> places;
  for (const Solid& solid : list.solids) {
    if (!isDrawable(solid)) continue;
    StoredMesh& mesh = store.find(solid.mesh);
    if (solid.is_ghost) {
      if (!mesh.edges) mesh.edges = computeMeshEdges(*solid.mesh);
      appendGhostLines(solid, *mesh.edges, p_WEye, grouped.ghost_lines);
      continue;
    }
    const auto [place, is_new] =
        places.try_emplace({&mesh, solid.has_grid}, grouped.batches.size());
    if (is_new)
      grouped.batches.push_back({.mesh = &mesh, .has_grid = solid.has_grid, .instances = {}});
    grouped.batches[place->second].instances.push_back(makeInstance(solid));
    // A floor has nothing below it that it could shadow.
    if (!solid.has_grid && (solid.p_WB - eye.target_W).norm() < kNear * eye.distance)
      grouped.casters.push_back({.p_W = solid.p_WB, .radius = mesh.radius});
  }
  for (SolidBatch& batch : grouped.batches) sortFromEye(batch.instances, p_WEye);
  return grouped;
}

}  // namespace tandem::view
