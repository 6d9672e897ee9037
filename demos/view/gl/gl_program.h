#pragma once

#include <string>

#include "gl/gl_object.h"
#include "gl/projection.h"

namespace tandem::view {

/// Makes a program of two shaders, each behind the version and `defines`. Throws Error with the
/// first line of the driver's log and the remedy.
[[nodiscard]] GlProgram makeProgram(const std::string& vertex_source, const char* fragment_source,
                                    const std::string& defines = {});

/// Throws Error if OpenGL has failed since it was last asked; `doing` says at what.
void requireNoGlError(const std::string& doing);

/// Set a uniform of the program in use. A name that the program does not use is ignored.
void setUniform(const GlProgram& program, const char* name, const Mat4& matrix);
void setUniform(const GlProgram& program, const char* name, const Vec3& vector);
void setUniform(const GlProgram& program, const char* name, double x, double y);
void setUniform(const GlProgram& program, const char* name, double number);
void setUniform(const GlProgram& program, const char* name, int number);

}  // namespace tandem::view
