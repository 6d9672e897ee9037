#include "gl/line_painter.h"

#include <cmath>
#include <cstddef>

#include "gl/gl_attribute.h"
#include "gl/gl_program.h"
#include "gl/shaders.h"

namespace tandem::view {
namespace {

struct LineInstance {
  float from[3], to[3], colour[3], width;
};

void put(float (&place)[3], const Vec3& vector) {
  for (int axis = 0; axis < 3; ++axis) place[axis] = static_cast<float>(vector[axis]);
}

std::vector<LineInstance> makeInstances(const std::vector<Line>& lines) {
  std::vector<LineInstance> instances;
  instances.reserve(lines.size());
  for (const Line& line : lines) {
    if (!line.from_W.allFinite() || !line.to_W.allFinite() || !(line.width > 0.0F)) continue;
    LineInstance& instance = instances.emplace_back();
    put(instance.from, line.from_W);
    put(instance.to, line.to_W);
    put(instance.colour, Vec3(line.colour.red, line.colour.green, line.colour.blue));
    instance.width = line.width;
  }
  return instances;
}

void readInstances(GLuint place, int count, std::size_t offset) {
  readAttribute(place, count, sizeof(LineInstance), offset, 1);
}

}  // namespace

LinePainter::LinePainter()
    : program_(makeProgram(shaders::kLineVertex, shaders::kLineFragment)),
      array_(makeVertexArray()),
      instances_(makeBuffer()) {
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
  readInstances(shaders::kFrom, 3, offsetof(LineInstance, from));
  readInstances(shaders::kTo, 3, offsetof(LineInstance, to));
  readInstances(shaders::kLineColour, 3, offsetof(LineInstance, colour));
  readInstances(shaders::kWidth, 1, offsetof(LineInstance, width));
  glBindVertexArray(0);
}

void LinePainter::draw(const std::vector<Line>& lines, const Eye& eye, PictureSize size) {
  const std::vector<LineInstance> instances = makeInstances(lines);
  if (instances.empty()) return;
  glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size() * sizeof(LineInstance)),
               instances.data(), GL_STREAM_DRAW);
  glUseProgram(program_.name());
  setUniform(program_, "world_to_clip", computeWorldToClip(eye, size));
  setUniform(program_, "size", size.width, size.height);
  setUniform(program_, "nearest", nearestDepth(eye));

  // A strip's winding depends on the line's direction on the screen.
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glBindVertexArray(array_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(instances.size()));
  glBindVertexArray(0);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
}

}  // namespace tandem::view
