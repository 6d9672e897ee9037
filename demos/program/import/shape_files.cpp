#include "import/shape_files.h"

#include "import/obj_file.h"

namespace tandem::demos {
namespace {

void readShapeFile(ShapeScenario& shape, const std::filesystem::path& folder) {
  if (shape.file.empty()) return;
  const ObjFile file = readObj(folder / shape.file);
  for (const Vec3& p : file.points) shape.points.push_back({p.x(), p.y(), p.z()});
  if (shape.kind == "mesh")
    for (const auto& [a, b, c] : file.triangles)
      shape.triangles.push_back({static_cast<int>(a), static_cast<int>(b), static_cast<int>(c)});
  shape.file.clear();
}

}  // namespace

void readShapeFiles(Scenario& scenario) {
  const std::filesystem::path folder = scenario.file.parent_path();
  for (BodyScenario& body : scenario.bodies) {
    readShapeFile(body.shape, folder);
    for (PartScenario& part : body.parts) readShapeFile(part.shape, folder);
  }
}

}  // namespace tandem::demos
