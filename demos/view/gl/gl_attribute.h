#pragma once

#include <cstddef>

#include "gl/gl_functions.h"

namespace tandem::view {

/// Lets an attribute of a shader read `count` floats at `offset` of each element of the bound
/// buffer: `stride` bytes apart, one for each vertex, or for each instance with `divisor` 1.
inline void readAttribute(GLuint place, int count, std::size_t stride, std::size_t offset,
                          GLuint divisor) {
  glEnableVertexAttribArray(place);
  glVertexAttribPointer(place, count, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                        reinterpret_cast<const void*>(offset));
  glVertexAttribDivisor(place, divisor);
}

}  // namespace tandem::view
