#include "import/obj_file.h"

#include <fmt/format.h>

#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include "import/import_file.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Adds a shape's triangles. Every number of a file may lie.
void addTriangles(const tinyobj::mesh_t& mesh, const std::string& name, ObjFile& file) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    std::array<std::size_t, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const int corner = mesh.indices[i + k].vertex_index;
      if (corner < 0 || static_cast<std::size_t>(corner) >= file.points.size())
        throw UsageError(fmt::format("{}: a face names point {}, but there are {}; export it again",
                                     name, corner + 1, file.points.size()));
      corners[k] = static_cast<std::size_t>(corner);
    }
    file.triangles.push_back(corners);
  }
}

}  // namespace

ObjFile readObj(const std::filesystem::path& path) {
  const std::string name = path.string();
  tinyobj::ObjReaderConfig config;
  config.vertex_color = false;
  tinyobj::ObjReader reader;
  if (!reader.ParseFromString(readImportFile(path), "", config))
    throw UsageError(fmt::format("{}: not an OBJ file: {}", name, firstLine(reader.Error())));
  ObjFile file;
  const std::vector<double>& numbers = reader.GetAttrib().vertices;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    const Vec3 point(numbers[i], numbers[i + 1], numbers[i + 2]);
    if (!(point.cwiseAbs().maxCoeff() <= 1e6))
      throw UsageError(fmt::format("{}: point {} is not finite or beyond 1e6 m", name, i / 3 + 1));
    file.points.push_back(point);
  }
  for (const tinyobj::shape_t& shape : reader.GetShapes()) addTriangles(shape.mesh, name, file);
  if (file.triangles.empty())
    throw UsageError(name + ": has no face; export a surface (lines \"f 1 2 3\")");
  return file;
}

}  // namespace tandem::demos
