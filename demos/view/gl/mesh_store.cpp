#include "gl/mesh_store.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "gl/gl_attribute.h"
#include "gl/gl_program.h"
#include "gl/shaders.h"

namespace tandem::view {
namespace {

constexpr std::uint64_t kKeptFrames = 300;

double computeRadius(const ShapeMesh& mesh) {
  double radius = 0.0;
  for (const ShapeMesh::Vertex& vertex : mesh.vertices)
    radius = std::max(radius, Vec3(vertex.p[0], vertex.p[1], vertex.p[2]).norm());
  return radius;
}

template <class Element>
GlBuffer fillBuffer(GLenum target, const std::vector<Element>& elements) {
  GlBuffer buffer = makeBuffer();
  glBindBuffer(target, buffer.name());
  glBufferData(target, static_cast<GLsizeiptr>(elements.size() * sizeof(Element)), elements.data(),
               GL_STATIC_DRAW);
  return buffer;
}

StoredMesh store(const ShapeMesh& mesh) {
  StoredMesh stored;
  stored.array = makeVertexArray();
  glBindVertexArray(stored.array.name());
  stored.vertices = fillBuffer(GL_ARRAY_BUFFER, mesh.vertices);
  stored.indices = fillBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices);
  using Vertex = ShapeMesh::Vertex;
  readAttribute(shaders::kPoint, 3, sizeof(Vertex), offsetof(Vertex, p), 0);
  readAttribute(shaders::kNormal, 3, sizeof(Vertex), offsetof(Vertex, n), 0);
  glBindVertexArray(0);
  stored.index_count = static_cast<int>(mesh.indices.size());
  stored.radius = computeRadius(mesh);
  requireNoGlError("storing a mesh");
  return stored;
}

}  // namespace

void MeshStore::beginFrame() {
  ++frame_;
  std::erase_if(meshes_, [this](const auto& entry) {
    return entry.first.owner.expired() || entry.second.last_use + kKeptFrames < frame_;
  });
}

StoredMesh& MeshStore::find(const std::shared_ptr<const ShapeMesh>& mesh) {
  const Key key = {.owner = mesh, .address = mesh.get()};
  auto place = meshes_.find(key);
  if (place == meshes_.end()) place = meshes_.emplace(key, store(*mesh)).first;
  place->second.last_use = frame_;
  return place->second;
}

}  // namespace tandem::view
