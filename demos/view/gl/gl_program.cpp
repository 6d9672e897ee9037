#include "gl/gl_program.h"

#include <array>

namespace tandem::view {
namespace {

constexpr const char* kRemedy =
    "; the graphics driver lacks OpenGL 3.3: update it, or set LIBGL_ALWAYS_SOFTWARE=1";

[[noreturn]] void failWithLog(const char* doing, const std::string& log) {
  throw Error(std::string(doing) + " failed: " + log.substr(0, log.find('\n')) + kRemedy);
}

GlShader compile(GLenum kind, const std::string& source) {
  GlShader shader(glCreateShader(kind));
  const char* const text = source.c_str();
  glShaderSource(shader.name(), 1, &text, nullptr);
  glCompileShader(shader.name());
  GLint is_good = GL_FALSE;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &is_good);
  if (is_good == GL_TRUE) return shader;
  std::array<char, 1024> log = {};
  glGetShaderInfoLog(shader.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  failWithLog("compiling a shader", log.data());
}

GLint locate(const GlProgram& program, const char* name) {
  return glGetUniformLocation(program.name(), name);
}

}  // namespace

GlProgram makeProgram(const std::string& vertex_source, const char* fragment_source,
                      const std::string& defines) {
  const std::string head = "#version 330 core\n" + defines;
  const GlShader vertex = compile(GL_VERTEX_SHADER, head + vertex_source);
  const GlShader fragment = compile(GL_FRAGMENT_SHADER, head + fragment_source);
  GlProgram program(glCreateProgram());
  glAttachShader(program.name(), vertex.name());
  glAttachShader(program.name(), fragment.name());
  glLinkProgram(program.name());
  glDetachShader(program.name(), vertex.name());
  glDetachShader(program.name(), fragment.name());
  GLint is_good = GL_FALSE;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &is_good);
  if (is_good == GL_TRUE) return program;
  std::array<char, 1024> log = {};
  glGetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  failWithLog("linking a shader", log.data());
}

void requireNoGlError(const std::string& doing) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  const char* const cause = error == GL_OUT_OF_MEMORY ? ": out of memory" : "";
  throw Error(doing + " failed with OpenGL error " + std::to_string(error) + cause + kRemedy);
}

void setUniform(const GlProgram& program, const char* name, const Mat4& matrix) {
  const Eigen::Matrix4f in_float = matrix.cast<float>();
  glUniformMatrix4fv(locate(program, name), 1, GL_FALSE, in_float.data());
}

void setUniform(const GlProgram& program, const char* name, const Vec3& vector) {
  const Eigen::Vector3f in_float = vector.cast<float>();
  glUniform3fv(locate(program, name), 1, in_float.data());
}

void setUniform(const GlProgram& program, const char* name, double x, double y) {
  glUniform2f(locate(program, name), static_cast<float>(x), static_cast<float>(y));
}

void setUniform(const GlProgram& program, const char* name, double number) {
  glUniform1f(locate(program, name), static_cast<float>(number));
}

void setUniform(const GlProgram& program, const char* name, int number) {
  glUniform1i(locate(program, name), number);
}

}  // namespace tandem::view
